#include <algorithm>

#include <fmt/format.h>

#include "analysis/statistics/confidence_sequence.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Shown;
using Point = const PointReading&;

statistics::ConfidenceInterval bounds(Point p, double confidence) {
  const measures::PointSummary& point = p.statistics();
  return statistics::confidence_sequence_bounds(point.outcomes.zero_count, point.judged, confidence);
}

/// At the confidence of the summary.
statistics::ConfidenceInterval bounds(Point p) {
  return bounds(p, p.summary.confidence);
}

/// At the confidence of the rule.
double halfwidth(Point p) {
  const statistics::ConfidenceInterval judged = bounds(p, p.summary.stop->confidence);
  return 0.5 * (judged.high - judged.low);
}

bool is_reached(Point p) {
  return halfwidth(p) <= p.summary.stop->success_rate_halfwidth;
}

std::string note_on_stopping(const SummaryReading& s) {
  const bool reached = std::ranges::all_of(s.points, is_reached);
  const std::int64_t rigs = s.summary.points.empty() ? 0 : s.summary.points.front().rigs.n;
  return fmt::format(
      "how many trials there are was decided by their outcomes, after every {} at each point{}; all other "
      "bounds are those of a number fixed beforehand\n{}",
      s.summary.stop->block,
      reached ? "" : ", and ended by max_trials before all was known as well as asked for",
      rigs == 0 ? ""
                : fmt::format("these bounds are of the mean over the {} rigs of the study, which more trials "
                              "narrow; those over all rigs are in the table above, and more rigs narrow "
                              "them\n",
                              rigs));
}

}  // namespace

void add_stopping(PointDescription& point, const summary::StudySummary& summary) {
  if (!summary.stop) return;
  const auto item = [](const char* key, const char* meaning) {
    return document::Item{.key = key, .meaning = meaning, .unit = "1", .shown = Shown::in_json};
  };
  const auto bound = [](const std::string& key, const char* side) {
    return document::Item{
        .key = key,
        .meaning = std::string(side) + " bound of the success rate that holds however often one looks",
        .unit = "1",
        .column = "stopped_" + key};
  };
  PointDescription object;
  object.value(bound("success_rate_low", "lower"), [](Point p) { return bounds(p).low; })
      .value(bound("success_rate_high", "upper"), [](Point p) { return bounds(p).high; })
      .value(item("confidence", "confidence of these bounds"), [](Point p) { return p.summary.confidence; })
      .value(item("halfwidth", "half the width of the bounds that the rule is about"), halfwidth)
      .value(item("halfwidth_asked", "half-width that the rule asks for"),
             [](Point p) { return p.summary.stop->success_rate_halfwidth; })
      .value(item("halfwidth_confidence", "confidence of the bounds that the rule is about"),
             [](Point p) { return p.summary.stop->confidence; })
      .value({.key = "reached",
              .meaning = "whether the bounds are as narrow as asked for",
              .shown = Shown::in_json},
             is_reached);
  if (summary.features.rigs)
    object.value({.key = "of_rigs",
                  .meaning = "rigs of the study, over whose mean the bounds are",
                  .shown = Shown::in_json},
                 [](Point p) { return p.statistics().rigs.n; });
  point.object({.key = "stopping",
                .meaning = "what the rule that ended the study asked for, and what was reached",
                .shown = Shown::in_data},
               object, [](Point p) -> const PointReading& { return p; });
}

void add_stopping(SummaryDescription& answer, const summary::StudySummary& summary) {
  if (!summary.stop) return;
  PointDescription columns = labelled_points(summary);
  columns
      .value({.heading = bounds_head(summary) + " of zero-count, however often one looks (%)"},
             [](Point p) {
               const statistics::ConfidenceInterval here = bounds(p);
               return fmt::format("[{}]", text::percent_bounds(here.low, here.high, 2));
             })
      .value({.heading = fmt::format("asked for: ± {:.4g} %, came to",
                                     100.0 * summary.stop->success_rate_halfwidth)},
             [](Point p) {
               return fmt::format("± {} %{}", text::rounded_up(100.0 * halfwidth(p), 2),
                                  is_reached(p) ? "" : ": not reached");
             });
  answer
      .table({.heading = "bounds of the stopping rule", .shown = Shown::to_people}, columns,
             &SummaryReading::points)
      .sentence(note_on_stopping);
}

}  // namespace zerocount::summary_answer
