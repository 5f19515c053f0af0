#include "analysis/goal/goal_chances.hpp"

#include <algorithm>
#include <utility>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/clusters/rig_proportion.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/proportion.hpp"
#include "core/numerics/bisection.hpp"

namespace zerocount::goal {

using numerics::first_where;

ObservedWorld::ObservedWorld(const study::Goal& goal, measures::MoveCounts counts, std::size_t points,
                             std::size_t parts)
    : goal_(goal),
      counts_(std::move(counts)),
      points_(points),
      parts_(parts),
      confidence_low_(statistics::confidence_of_each(goal.confidence, points)),
      confidence_high_(statistics::confidence_of_each(goal.confidence, points * parts)),
      sums_(measures::clusters_of(counts_)) {
  if (!goal_.machines) {
    worth_ = sums_.hits > 0 && sums_.hits < sums_.events ? statistics::effective_events(sums_)
                                                         : static_cast<double>(sums_.events);
    of_all_moves_ = likely_proportions(statistics::rate(sums_.hits, sums_.events) * worth_, worth_);
    return;
  }
  for (const statistics::RigMoves& rig : counts_.rigs) ++machines_[rig.met];
}

Chances ObservedWorld::chances_of(const PlannedSize& planned) {
  return goal_.machines ? of_machines(planned) : of_moves(planned);
}

/// After `hits` of `events`, which need not be whole numbers.
ObservedWorld::Proportions ObservedWorld::likely_proportions(double hits, double events) {
  Proportions values{};
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = statistics::lower_bound_on_p(
        hits + 0.5, events, (static_cast<double>(i) + 0.5) / static_cast<double>(values.size()));
  return values;
}

double ObservedWorld::chance_of_at_least(const Proportions& proportions, std::int64_t events,
                                         std::int64_t hits) {
  if (hits > events) return 0.0;
  if (hits <= 0) return 1.0;
  double sum = 0.0;
  for (const double p : proportions) sum += statistics::binomial_upper_tail(events, p, hits - 1);
  return sum / static_cast<double>(proportions.size());
}

/// Independent moves that all clusters of the planned study are worth.
double ObservedWorld::planned_events(const PlannedSize& planned) const {
  const auto clusters = static_cast<double>(sums_.clusters);
  const double moves = static_cast<double>(sums_.events) / clusters;
  const double worth = std::min(moves, worth_ / clusters);
  const double between = 1.0 / worth - 1.0 / moves;
  const double events = static_cast<double>(planned.units) /
                        (between + 1.0 / (moves * static_cast<double>(planned.more_on_each_rig)));
  if (sums_.clusters == sums_.events) return events;
  // The bounds use Student's distribution, because the differences between clusters are estimated.
  const double t = statistics::student_t_quantile(static_cast<double>(planned.units - 1), confidence_high_) /
                   statistics::student_t_quantile(std::max(1.0, events - 1.0), confidence_high_);
  return std::max(1.0, events / (t * t));
}

/// Single events stand for those that the clusters are worth; the number of clusters limits what they show.
Chances ObservedWorld::of_moves(const PlannedSize& planned) const {
  const auto n = static_cast<std::int64_t>(planned_events(planned));
  const auto status = [&](std::int64_t hits) {
    const auto k = static_cast<double>(hits);
    const measures::MoveCounts counts{
        .moves = n, .met = hits, .of_trials = {n, hits, n, k, k, static_cast<double>(n)}, .rigs = {}};
    return judge_goal(goal_, counts, points_, parts_).status;
  };
  const auto clusters = static_cast<double>(planned.units);
  const bool can_meet = statistics::shown_by_clusters(clusters, confidence_low_) >= goal_.moves;
  const bool can_miss = 1.0 - statistics::shown_by_clusters(clusters, confidence_high_) < goal_.moves;
  const std::int64_t met =
      can_meet ? first_where(0, n + 1, [&](std::int64_t hits) { return status(hits) == Status::met; })
               : n + 1;
  const std::int64_t not_missed =
      can_miss ? first_where(0, n + 1, [&](std::int64_t hits) { return status(hits) != Status::missed; }) : 0;
  return {chance_of_at_least(of_all_moves_, n, met), 1.0 - chance_of_at_least(of_all_moves_, n, not_missed)};
}

/// So many of the rigs observed would show `met` or more moves that meet the goal.
double ObservedWorld::rigs_passing(std::int64_t met, std::int64_t more) {
  const auto [at, is_new] = passing_.try_emplace({met, more}, 0.0);
  if (!is_new) return at->second;
  const std::int64_t moves = counts_.rigs.front().moves;
  for (const auto& [observed, rigs] : machines_) {
    const double chance =
        met <= 0 ? 1.0
                 : statistics::binomial_upper_tail(moves * more, statistics::rate(observed, moves), met - 1);
    at->second += static_cast<double>(rigs) * chance;
  }
  return at->second;
}

/// The chance of the mark that shows best what is wanted: that of any of them is not smaller.
Chances ObservedWorld::of_machines(const PlannedSize& planned) {
  const statistics::RigMoves& rig = counts_.rigs.front();
  const statistics::RigStudy study{planned.units, rig.trials * planned.more_on_each_rig,
                                   rig.moves * planned.more_on_each_rig};
  const auto observed = static_cast<double>(counts_.rigs.size());
  const auto chance = [&](const statistics::RigBound::Enough& enough, double passing) {
    if (enough.rigs > study.rigs) return 0.0;
    return statistics::binomial_upper_tail(study.rigs, std::clamp(passing / observed, 0.0, 1.0),
                                           enough.rigs - 1);
  };
  Chances chances;
  const statistics::RigClaim met{goal_.moves, *goal_.machines, confidence_low_};
  for (const auto& enough : statistics::RigBound(study, met).enough())
    chances.met = std::max(chances.met, chance(enough, rigs_passing(enough.met, planned.more_on_each_rig)));
  const statistics::RigClaim missed =
      statistics::of_missing({goal_.moves, *goal_.machines, confidence_high_});
  for (const auto& enough : statistics::RigBound(study, missed).enough()) {
    const std::int64_t at_most = study.moves - enough.met;
    const double missing = observed - rigs_passing(at_most + 1, planned.more_on_each_rig);
    chances.missed = std::max(chances.missed, chance(enough, missing));
  }
  return chances;
}

}  // namespace zerocount::goal
