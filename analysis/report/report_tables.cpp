#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/document/blocks.hpp"
#include "analysis/document/markup.hpp"
#include "analysis/report/report_sections.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "analysis/summary_answer/summary_answer.hpp"
#include "analysis/text/text.hpp"
#include "core/text/counted.hpp"
#include "core/text/shell_word.hpp"

namespace zerocount::report {
namespace {

using document::Notation;
using summary_answer::PointReading;
using summary_answer::SummaryReading;
using Point = const PointReading&;

constexpr std::size_t max_rows = 400;

/// A quantile of settling times with its bounds, of which one may not be reached within the hold.
std::string quantile_text(Point p, const statistics::Quantile& quantile) {
  std::string value = summary_answer::settling_text(p.statistics(), quantile.value);
  if (std::isnan(quantile.low) && std::isnan(quantile.high)) return value;
  return fmt::format("{} [{}, {}]", value, std::isnan(quantile.low) ? "0" : text::short_number(quantile.low),
                     summary_answer::settling_text(p.statistics(), quantile.high));
}

/// Trials by their worst move.
summary_answer::PointDescription outcome_columns(const summary::StudySummary& summary) {
  summary_answer::PointDescription columns = summary_answer::labelled_points(summary);
  const auto count = [](std::int64_t measures::OutcomeCounts::*outcome) {
    return [outcome](Point p) { return p.statistics().outcomes.*outcome; };
  };
  using Counts = measures::OutcomeCounts;
  columns.value({.heading = "trials"}, [](Point p) { return p.statistics().trials; })
      .value({.heading = "zero-count"}, count(&Counts::zero_count))
      .value({.heading = "one count"}, count(&Counts::one_count))
      .value({.heading = "undecided"}, count(&Counts::off_target))
      .value({.heading = "oscil\u00adlating"}, count(&Counts::oscillating))
      .value({.heading = "lost"}, count(&Counts::nonfinite));
  if (!summary.features.rigs) return columns;
  return columns
      .value(
          {.heading = "machines without failure [95 % bounds]", .unit = "1", .notation = Notation::percent},
          [](Point p) {
            const statistics::RigStatistics& rigs = p.statistics().rigs;
            return document::Bounded{rigs.without_failure, rigs.without_failure_bounds.low,
                                     rigs.without_failure_bounds.high};
          })
      .value({.heading = "sd between machines"}, [](Point p) { return p.statistics().rigs.success_sd; })
      .value({.heading = "worst 5 % of machines", .unit = "1", .notation = Notation::percent},
             [](Point p) { return p.statistics().rigs.worst_5_percent; });
}

/// Quantiles of times with their bounds.
summary_answer::PointDescription time_columns(const summary::StudySummary& summary) {
  summary_answer::PointDescription columns = summary_answer::labelled_points(summary);
  const auto add = [&](const std::string& heading, auto quantile) {
    columns.value({.heading = heading, .unit = "s", .numeric = true},
                  [quantile](Point p) { return quantile_text(p, quantile(p.statistics())); });
  };
  using Statistics = const measures::PointSummary&;
  add("arrival, median", [](Statistics s) { return s.of(&trial::MoveOutcome::arrival_time).median; });
  add("arrival, 95 %", [](Statistics s) { return s.of(&trial::MoveOutcome::arrival_time).p95; });
  for (const std::int64_t band : summary.features.bands.values())
    add(fmt::format("settled ±{}, 95 %", band),
        [band](Statistics s) { return measures::of_band(s, "band_settling_time", band).p95; });
  return columns;
}

/// What the report says of zero counts beyond the summary.
document::Description<SummaryReading> zero_count_description(const summary::StudySummary& summary) {
  const std::string of_rigs =
      summary.features.rigs ? " Sd between rigs: standard deviation of the success probability. Worst "
                              "5 % of machines: mean observed success rate of the machines with the lowest "
                              "rates."
                            : "";
  document::Description<SummaryReading> tables;
  if (summary.features.open_loop) return tables;
  return tables
      .table(
          {.heading = "trials by their worst move",
           .note = "Undecided: a move ended off target (stalled or still moving); it is neither stable nor "
                   "shown unstable." +
                   of_rigs},
          outcome_columns(summary), &SummaryReading::points)
      .table({.heading = "times with their bounds",
              .note = "Arrival: the error is first 0 for the whole dwell. Settled ±b: the error stays within "
                      "b counts from then to the end of the move. Quantiles are those of all moves, with "
                      "order-statistic bounds; moves that never arrived, or end outside, are later than all "
                      "others."},
             time_columns(summary), &SummaryReading::points);
}

/// The points that fit into the table.
std::vector<std::int64_t> first_points(const ReportedStudy& reported) {
  const std::size_t rows_of_point =
      reported.study.open_loop ? std::max<std::size_t>(1, static_cast<std::size_t>(reported.file.moves()))
                               : 1;
  std::vector<std::int64_t> points(
      std::min(reported.summary.points.size(), std::max<std::size_t>(1, max_rows / rows_of_point)));
  std::iota(points.begin(), points.end(), std::int64_t{0});
  return points;
}

std::string html_of(const ReportedStudy& reported, document::Description<SummaryReading> tables) {
  const document::AnswerDescription<SummaryReading> answer{{}, std::move(tables)};
  const SummaryReading reading =
      summary_answer::read_summary(reported.summary, {first_points(reported), reported.chosen.point, true});
  return document::html(answer.of(reading, ExitCode::success, document::Audience::people));
}

}  // namespace

std::string points_html(const ReportedStudy& reported) {
  const summary::StudySummary& summary = reported.summary;
  document::Description<SummaryReading> tables;
  const auto same = [](const SummaryReading& s) -> const SummaryReading& { return s; };
  tables.sentence([](const SummaryReading& s) { return summary_answer::design_line(s.summary); })
      .include(summary_answer::point_tables(summary), same);
  if (!summary.question.claim()) tables.include(zero_count_description(summary), same);
  std::string html = html_of(reported, std::move(tables));
  const std::size_t shown = first_points(reported).size();
  if (shown < summary.points.size()) {
    html += fmt::format(
        "<p class=\"note\">The first {} of {} points; all are printed by <code>zerocount "
        "summary</code>.</p>\n",
        shown, summary.points.size());
  }
  return html;
}

std::string zero_count_tables_html(const ReportedStudy& reported) {
  return html_of(reported, zero_count_description(reported.summary));
}

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

/// The sweep: the range of each number of the grid, and the cases.
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

/// Commands that make the study again, and that check the file.
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
