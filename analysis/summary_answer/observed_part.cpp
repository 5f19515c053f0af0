#include <algorithm>

#include <fmt/format.h>

#include "analysis/measures/field_description.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Shown;
using Point = const PointReading&;

std::string observed_statement(Point p) {
  return summary::statement_on(p.statistics(), *p.observed, p.summary.confidence);
}

std::string simulated_text(Point p) {
  const measures::PointSummary& point = p.statistics();
  if (point.judged == 0) return "–";
  return fmt::format("{} of {}{}{}", text::percentage(point.outcomes.zero_count, point.judged), point.judged,
                     point.rigs.n > 0 ? fmt::format(" on {} rigs", point.rigs.n) : "",
                     point.worlds ? ", on average over the worlds" : "");
}

PointDescription observed_object() {
  return PointDescription()
      .value({.key = "successes", .meaning = "trials that succeeded on the real rig"},
             [](Point p) { return p.observed->counts.successes; })
      .value({.key = "of", .meaning = "trials on the real rig"},
             [](Point p) { return p.observed->counts.of; })
      .value({.key = "p_value", .meaning = "two-sided p-value; null where it cannot be tested", .unit = "1"},
             [](Point p) { return p.observed->test ? p.observed->test->p : statistics::unknown; })
      .value({.key = "lowest_p_value", .meaning = "lowest p-value that any result can have", .unit = "1"},
             [](Point p) { return p.observed->test ? p.observed->test->lowest_p : statistics::unknown; })
      .value({.key = "verdict",
              .meaning = "whether the simulation and the real rig are consistent",
              .words = {std::begin(summary::observed_verdicts), std::end(summary::observed_verdicts)}},
             [](Point p) { return summary::verdict_on(*p.observed, p.summary.confidence); })
      .value({.key = "statement", .meaning = "the verdict in words"}, observed_statement);
}

}  // namespace

void add_observed(PointDescription& point, const summary::StudySummary& summary) {
  if (summary.observed_counts.empty()) return;
  point.object({.key = "observed_counts",
                .meaning = "trials on the real rig against those simulated",
                .shown = Shown::in_json},
               observed_object(), [](Point p) { return p.observed ? &p : nullptr; });
  for (const summary::ObservedField& field : summary::observed_fields())
    measures::add_field(
        point, field, field.name, summary.features.axis, Shown::in_csv,
        [](Point p) -> const auto& { return p.observed; });
}

void add_observed(SummaryDescription& answer, const summary::StudySummary& summary) {
  if (summary.observed_counts.empty()) return;
  PointDescription columns = labelled_points(summary);
  columns
      .value({.heading = "real rig"},
             [](Point p) {
               return fmt::format("{} of {}", p.observed->counts.successes, p.observed->counts.of);
             })
      .value({.heading = "simulated"}, simulated_text)
      .value({.heading = "the simulation and the rig"}, observed_statement);
  answer
      .table({.heading = "observed on the real rig", .shown = Shown::to_people}, columns,
             [](const SummaryReading& s) {
               return points_that(s, [](Point p) { return p.observed.has_value(); });
             })
      .sentence([](const SummaryReading& s) -> std::string {
        if (std::ranges::none_of(s.points, [](Point p) { return p.observed.has_value(); })) return {};
        return fmt::format(
            "{}, each point by itself: it differs where p ≤ {}. Consistent counts do not prove the "
            "simulation "
            "right: they only do not contradict it",
            s.summary.features.rigs
                ? "rank of the real rig among the simulated ones, by as many trials of each"
                : "Fisher's exact test",
            text::percent(1.0 - s.summary.confidence));
      });
}

}  // namespace zerocount::summary_answer
