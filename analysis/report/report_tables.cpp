#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/report/report_sections.hpp"
#include "analysis/trials/summary_answer/parts.hpp"
#include "analysis/trials/summary_answer/summary_answer.hpp"
#include "core/text/text.hpp"

namespace zerocount::report {
namespace {

constexpr std::size_t max_rows = 400;

/// Indices of the design points that fit into the table: the first ones.
std::vector<std::int64_t> first_points(const ReportedStudy& reported) {
  const std::size_t rows_of_point =
      reported.study.open_loop ? std::max<std::size_t>(1, static_cast<std::size_t>(reported.file.moves()))
                               : 1;
  std::vector<std::int64_t> points(
      std::min(reported.summary.points.size(), std::max<std::size_t>(1, max_rows / rows_of_point)));
  std::iota(points.begin(), points.end(), std::int64_t{0});
  return points;
}

}  // namespace

std::string points_html(const ReportedStudy& reported) {
  const summary::StudySummary& summary = reported.summary;
  document::AnswerDescription<summary_answer::SummaryResults> answer;
  answer.items.sentence([&](const auto& s) { return summary_answer::design_line(s.summary); })
      .include(
          summary_answer::point_tables(summary), [](const auto& s) -> const auto& { return s; });
  const std::vector<std::int64_t> shown = first_points(reported);
  std::string html =
      document::html(answer.of(summary_answer::read_summary(summary, {shown, reported.chosen.point, true}),
                               ExitCode::success, document::Audience::people));
  if (shown.size() < summary.points.size()) {
    html += fmt::format(
        "<p class=\"note\">The first {} of {} points; all are printed by <code>zerocount "
        "summary</code>.</p>\n",
        shown.size(), summary.points.size());
  }
  return html;
}

namespace {

/// Facts about the parameter sweep: the range of each swept number, and the cases.
std::vector<document::Fact> sweep_facts(const ReportedStudy& reported) {
  std::vector<document::Fact> facts;
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

/// Commands by which the reader can run the study again, and check the file, as text.
std::string commands_text(const ReportedStudy& reported) {
  const std::string file = text::shell_path(reported.file.path().filename());
  return fmt::format("zerocount run {0} -o again.h5; zerocount verify {0}", file);
}

std::vector<document::Fact> facts_of(const ReportedStudy& reported) {
  const layout::FileHeader& header = reported.file.header();
  const layout::Provenance& made = header.provenance;
  std::vector<document::Fact> facts{
      {"File", reported.file.path().filename().string()},
      {"Seed", fmt::format("{}", header.seed)},
      {"Program", fmt::format("zerocount {} ({}), {} engine; {}", made.zerocount_version, made.git_commit,
                              layout::name_of(header.engine), made.created)},
      {"Compiler, processor", fmt::format("{}; {}", made.compiler, made.cpu)},
      {"SHA-256 of the manifest", header.manifest_sha256},
      {"To repeat it", commands_text(reported)},
      {"Trials",
       fmt::format("{} at each of {}, {} each: {}", header.trials,
                   text::counted(header.points, "design point"), text::counted(reported.file.moves(), "move"),
                   text::counted(header.points * header.trials, "trial"))},
      {"Design", reported.summary.design + (reported.study.independent_points
                                                ? ", drawn anew at each point"
                                                : "; all points share the draws of a trial")}};
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
  for (document::Fact& fact : sweep_facts(reported)) facts.push_back(std::move(fact));
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
  return html + document::html(document::FactsBlock{facts_of(reported)}) +
         html_folded("The manifest",
                     fmt::format("<pre>{}</pre>", document::markup(reported.file.header().manifest)));
}

}  // namespace zerocount::report
