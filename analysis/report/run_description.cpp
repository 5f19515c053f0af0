#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/document/markup.hpp"
#include "analysis/report/html.hpp"
#include "analysis/report/report_sections.hpp"
#include "analysis/report/reported_study.hpp"
#include "analysis/statistics/sums/moments.hpp"
#include "analysis/text/text.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::report {
namespace {

std::string design_text(const study::Study& study) {
  std::string text;
  switch (study.design) {
    case study::Design::monte_carlo:
      text = "Monte Carlo";
      break;
    case study::Design::latin_hypercube:
      text = "Latin hypercube";
      break;
    case study::Design::sobol:
      text = "Sobol' sequence";
      break;
    case study::Design::saltelli:
      text = "Saltelli's, for Sobol' indices";
      break;
  }
  return text + (study.independent_points ? ", drawn anew at each point"
                                          : "; all points share the draws of a trial");
}

/// Moments and extremes of an input column in the file.
statistics::Moments moments_of(const reading::AllTrialsFile& file, std::size_t column) {
  statistics::Moments moments;
  const std::int64_t at_once = layout::chunk_rows(1);
  for (std::int64_t first = 0; first < file.rows().end(); first += at_once) {
    for (const double value : file.input(column, {first, std::min(at_once, file.rows().end() - first)}))
      moments.add(value);
  }
  return moments;
}

std::string inputs_table(const reading::AllTrialsFile& file) {
  std::vector<HtmlColumn> columns{{"parameter", "", true, {}}, {"meaning", "", true, {}},
                                  {"unit", "", true, {}},      {"smallest", "", false, {}},
                                  {"mean", "", false, {}},     {"largest", "", false, {}}};
  for (std::size_t i = 0; i < file.input_columns().size(); ++i) {
    const study::InputColumn& input = file.input_columns()[i];
    const statistics::Moments values = moments_of(file, i);
    add_row(columns, {input.name, input.meaning, input.unit, text::short_number(values.min),
                      text::short_number(values.mean), text::short_number(values.max)});
  }
  if (columns.front().cells.empty()) return "<p>All trials have the same parameters.</p>\n";
  return "<h3>Parameters that differ between trials</h3>\n" + html_table(columns);
}

/// A value as a manifest has it: the word of an enumeration, the targets of a list.
std::string value_text(const parameters::Parameter& row, double value) {
  if (row.none == value) return "none";
  const auto index = static_cast<std::size_t>(value);
  if (!row.labels.empty() && index < row.labels.size()) return std::string(row.labels[index]);
  return fmt::format("{:.6g}", value);
}

/// The parameters that are the same in all trials of all points.
std::string fixed_table(const ReportedStudy& reported) {
  const study::Study& study = reported.study;
  const auto differs = [&](std::string_view name) {
    const auto is_it = [name](const auto& column) {
      return column.name == name || column.name.rfind(std::string(name) + ".", 0) == 0;
    };
    return std::ranges::any_of(study.columns.inputs, is_it) || std::ranges::any_of(study.points.axes, is_it);
  };
  const trial::TrialParameters parameters = study::study_trial(study, reported.chosen.point, 0).parameters;
  std::vector<HtmlColumn> columns{{"parameter", "", true, {}},
                                  {"meaning", "", true, {}},
                                  {"unit", "", true, {}},
                                  {"value", "", true, {}}};
  for (const parameters::Parameter& row : parameters::parameter_table()) {
    if (!row.get || differs(row.name) || (row.only_on && *row.only_on != study.units.axis)) continue;
    const double value = row.get(parameters);
    if (std::isnan(value)) continue;
    add_row(columns, {std::string(row.name), parameters::text_on(study.units.axis, std::string(row.meaning)),
                      parameters::unit_on(study.units.axis, std::string(row.unit)), value_text(row, value)});
  }
  return "<h3>Parameters that are the same in all trials</h3>\n" + html_table(columns);
}

/// The sweep: the range of each number of the grid, and the cases.
std::vector<HtmlFact> sweep_facts(const ReportedStudy& reported) {
  std::vector<HtmlFact> facts;
  for (const std::size_t i : numeric_axes(reported, 2)) {
    const study::SweepAxis& axis = reported.summary.axes[i];
    const std::vector<double> values = values_of(axis);
    facts.push_back(
        {"Swept", fmt::format("{}, {} values from {} to {}{}", axis.name, values.size(),
                              text::short_number(values.front()), text::short_number(values.back()),
                              axis.unit == "1" ? "" : " " + axis.unit)});
  }
  for (const study::SweepAxis& axis : reported.summary.axes) {
    if (axis.name != "case") continue;
    std::vector<std::string> names;
    for (const std::string& name : axis.texts) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    facts.push_back({"Cases", fmt::format("{}", fmt::join(names, ", "))});
  }
  return facts;
}

/// Commands that make the study again, and that check the file.
std::string commands_text(const ReportedStudy& reported) {
  const std::string file = reported.file.path().filename().string();
  return fmt::format("zerocount run {0} -o again.h5; zerocount verify {0}", file);
}

std::vector<HtmlFact> facts_of(const ReportedStudy& reported) {
  const layout::FileHeader& header = reported.file.header();
  const layout::Provenance& made = header.provenance;
  std::vector<HtmlFact> facts{
      {"File", reported.file.path().filename().string()},
      {"Seed", fmt::format("{}", header.seed)},
      {"Program", fmt::format("zerocount {} ({}), {} engine; {}", made.zerocount_version, made.git_commit,
                              layout::name_of(header.engine), made.created)},
      {"Compiler, processor", fmt::format("{}; {}", made.compiler, made.cpu)},
      {"SHA-256 of the manifest", header.manifest_sha256},
      {"To repeat it", commands_text(reported)},
      {"Trials", fmt::format("{} at each of {} design point{}, {} move{} each: {} trials", header.trials,
                             header.points, header.points == 1 ? "" : "s", reported.file.moves(),
                             reported.file.moves() == 1 ? "" : "s", header.points * header.trials)},
      {"Design", design_text(reported.study)}};
  if (!header.overrides.empty())
    facts.push_back({"Set on the command line", fmt::format("{}", fmt::join(header.overrides, ", "))});
  if (header.plugin) {
    facts.push_back({"Controller", fmt::format("plugin {} {}, SHA-256 {}", header.plugin->name,
                                               header.plugin->version, header.plugin->sha256)});
  }
  if (reported.study.samples)
    facts.push_back({"Sampled together", study::samples_text(*reported.study.samples)});
  if (!reported.study.correlations.empty())
    facts.push_back({"Correlated", study::correlations_text(reported.study.correlations)});
  for (HtmlFact& fact : sweep_facts(reported)) facts.push_back(std::move(fact));
  return facts;
}

}  // namespace

std::string run_html(const ReportedStudy& reported) {
  std::string html;
  if (layout::is_dirty(reported.file.header().provenance)) {
    html +=
        "<p class=\"warning\">The program that ran this study had uncommitted changes: it cannot be built "
        "again from its history.</p>\n";
  }
  html += html_facts(facts_of(reported));
  html += html_folded("All parameters", inputs_table(reported.file) + fixed_table(reported));
  return html + html_folded("The manifest",
                            fmt::format("<pre>{}</pre>", document::markup(reported.file.header().manifest)));
}

}  // namespace zerocount::report
