#include <algorithm>

#include <fmt/format.h>

#include "analysis/measures/undecided_moves.hpp"
#include "analysis/summary_answer/parts.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Shown;
using Point = const PointReading&;

bool has_undecided(Point p) {
  return measures::any_undecided(p.statistics().undecided);
}

/// A converter that clips keeps moves from their targets, too.
std::string undecided_text(Point p) {
  const std::int64_t clipped = p.statistics().of(&trial::MoveOutcome::saturated).trials;
  return measures::undecided_sentence(p.statistics().undecided) +
         (clipped == 0
              ? ""
              : fmt::format("; the converter clipped in {} of {} trials", clipped, p.statistics().trials));
}

}  // namespace

void add_undecided(PointDescription& point, const summary::StudySummary& summary) {
  if (summary.features.open_loop) return;
  PointDescription object;
  object.value({.key = "moves", .meaning = "moves of all trials", .shown = Shown::in_json},
               [](Point p) { return p.statistics().undecided.moves; });
  for (const measures::UndecidedCount& each : measures::undecided_counts)
    object.value({.key = each.name, .meaning = each.long_name, .column = each.column},
                 [count = each.count](Point p) { return p.statistics().undecided.*count; });
  object.value({.key = "hold_at_least",
                .meaning = "hold that most of the undecided moves are expected to need",
                .unit = "s",
                .column = "hold_at_least"},
               [](Point p) { return p.statistics().undecided.advised_hold; });
  point.object({.key = "undecided",
                .meaning = "moves that are neither stable nor shown unstable",
                .shown = Shown::in_data},
               object, [](Point p) -> const PointReading& { return p; });
}

void add_undecided(SummaryDescription& answer, const summary::StudySummary& summary) {
  if (summary.features.open_loop) return;
  PointDescription columns = labelled_points(summary);
  columns.value({.heading = "undecided moves"}, undecided_text);
  answer
      .table({.heading = "undecided moves", .shown = Shown::to_people}, columns,
             [](const SummaryReading& s) { return points_that(s, has_undecided); })
      .sentence([](const SummaryReading& s) {
        return std::string(std::ranges::any_of(s.points, has_undecided) ? measures::undecided_meaning : "");
      });
}

}  // namespace zerocount::summary_answer
