#include "analysis/summary/claims_of_point.hpp"

#include <cmath>

#include "analysis/goal/goal_description.hpp"
#include "analysis/goal/question.hpp"

namespace zerocount::summary {
namespace {

std::optional<double> known(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

/// The claim on one goal under one condition.
ClaimOfPoint claim_of(const goal::JudgedPart& part, const goal::Verdict& verdict,
                      const measures::MoveCounts& counts) {
  ClaimOfPoint claim{.moves = counts.moves,
                     .met = counts.met,
                     .rate = verdict.moves,
                     .within = part.claim->within,
                     .status = verdict.status};
  if (!part.claim->name.empty()) claim.goal = part.claim->name;
  if (part.claim->machines) claim.machines = verdict.machines;
  return claim;
}

}  // namespace

std::vector<ClaimOfPoint> claims_of_point(const StudySummary& summary, std::int64_t point,
                                          std::size_t points) {
  std::vector<ClaimOfPoint> claims;
  const measures::PointSummary& statistics = summary.points[static_cast<std::size_t>(point)];
  const goal::Question& question = summary.question;
  if (!question.claim() || statistics.judged == 0) return claims;
  const goal::Verdict verdict = verdict_on(question, statistics, points);
  for (const goal::GoalTimes& times : goal_times(question, statistics)) {
    const goal::JudgedPart& part = question.parts[times.part];
    const goal::Verdict& of_goal = verdict.goals.empty() ? verdict : verdict.goals[times.part];
    const bool has_conditions = !of_goal.conditions.empty();
    ClaimOfPoint& claim =
        claims.emplace_back(claim_of(part, has_conditions ? of_goal.conditions[times.condition] : of_goal,
                                     under_condition(statistics.goals[part.number], times.condition)));
    if (has_conditions) claim.condition = question.conditions[times.condition];
    claim.settling_time_p95 = known(times.statistics->p95.value);
  }
  return claims;
}

document::Description<ClaimOfPoint> claim_description() {
  using Of = const ClaimOfPoint&;
  document::Description<ClaimOfPoint> description;
  description
      .value({.key = "goal", .heading = "goal", .meaning = "name of the goal", .optional = true},
             &ClaimOfPoint::goal)
      .value({.key = "condition",
              .heading = "condition",
              .meaning = "the condition under which it is judged",
              .optional = true},
             &ClaimOfPoint::condition)
      .value({.key = "moves",
              .heading = "moves",
              .meaning = "moves that the goal asks, of all trials under the condition"},
             &ClaimOfPoint::moves)
      .value({.key = "met", .heading = "in goal", .meaning = "of them, moves that meet the goal"},
             &ClaimOfPoint::met)
      .value({.key = "rate",
              .heading = "moves in goal [bounds]",
              .meaning = "proportion of these moves, with one-sided bounds; with worlds of the worst world",
              .unit = "1",
              .notation = document::Notation::percent},
             [](Of c) { return goal::bounded(c.rate); })
      .value({.key = "machines",
              .heading = "machines in goal [bounds]",
              .meaning = "proportion of machines that meet the goal, with one-sided bounds",
              .unit = "1",
              .notation = document::Notation::percent,
              .optional = true},
             [](Of c) -> std::optional<document::Bounded> {
               if (!c.machines) return std::nullopt;
               return goal::bounded(*c.machines);
             })
      .value({.key = "settling_time_p95",
              .heading = "95 % within",
              .meaning = "95 % quantile of the settling time of these moves; null where it is not within "
                         "the hold",
              .unit = "s",
              .optional = true},
             &ClaimOfPoint::settling_time_p95)
      .value({.key = "within",
              .heading = "allowed",
              .meaning = "settling time that the goal allows",
              .unit = "s"},
             &ClaimOfPoint::within)
      .value({.key = "status",
              .heading = "verdict",
              .meaning = "verdict on the goal under the condition",
              .words = goal::status_words()},
             [](Of c) { return std::string(goal::text_of(c.status)); });
  return description;
}

}  // namespace zerocount::summary
