#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/report/report_sections.hpp"
#include "analysis/trials/summary_answer/parts.hpp"
#include "core/text/text.hpp"

namespace zerocount::report {
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
