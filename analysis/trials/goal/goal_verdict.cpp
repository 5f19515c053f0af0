#include "analysis/trials/goal/goal_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/clusters/machine_proportion.hpp"

namespace zerocount::goal {
namespace {

Status status_of(const BoundedProportion& proportion, double wanted) {
  if (proportion.low >= wanted) return Status::met;
  return proportion.high < wanted ? Status::missed : Status::undecided;
}

/// Confidences of the bounds for one part (a world, or a claim), if all parts must be met.
struct Confidences {
  /// Confidence of lower bounds. It is not corrected for the number of parts, because the goal must be met in
  /// every part.
  double low;
  /// Confidence of upper bounds, corrected for the number of parts (Bonferroni), because a miss in one part
  /// is a miss of the whole.
  double high;

  Confidences(const study::Goal& goal, std::size_t points, std::size_t parts)
      : low(statistics::confidence_of_each(goal.confidence, points)),
        high(statistics::confidence_of_each(goal.confidence, points * parts)) {}
};

WorldVerdict judge_world(const study::Goal& goal, const measures::MoveCounts& counts,
                         const Confidences& confidence) {
  const statistics::ClusterSums clusters = measures::clusters_of(counts);
  WorldVerdict verdict;
  verdict.moves = {statistics::rate(counts.met, counts.moves),
                   statistics::clustered_at_least(clusters, confidence.low),
                   statistics::clustered_at_most(clusters, confidence.high)};
  verdict.machines_without_miss =
      std::count_if(counts.machines.begin(), counts.machines.end(),
                    [](const statistics::MachineMoves& machine) { return machine.met == machine.moves; });
  if (!goal.machines) {
    verdict.status = status_of(verdict.moves, goal.moves);
    return verdict;
  }
  const auto machines = [&](double one) {
    return statistics::machine_proportion(counts.machines, {goal.moves, *goal.machines, one});
  };
  const statistics::MachineProportion low = machines(confidence.low);
  const double high = confidence.high == confidence.low ? low.high : machines(confidence.high).high;
  verdict.machines_meeting = low.meeting;
  const std::int64_t all = std::ssize(counts.machines);
  verdict.without_miss = {
      statistics::rate(verdict.machines_without_miss, all),
      statistics::proportion_at_least(verdict.machines_without_miss, all, confidence.low),
      statistics::proportion_at_most(verdict.machines_without_miss, all, confidence.high)};
  verdict.machines = {statistics::rate(low.meeting, all), low.low, high};
  verdict.status = status_of(verdict.machines, *goal.machines);
  return verdict;
}

/// Difference of the logits of the observed and the wanted proportion; positive if more was observed than
/// wanted. Infinite if nothing was observed, so that such proportions rank last.
double observed_margin(const BoundedProportion& proportion, double wanted) {
  if (std::isnan(proportion.value)) return std::numeric_limits<double>::infinity();
  return logit_difference(proportion.value, wanted);
}

/// Standing (rank) of a verdict, by its status first.
/// @param verdict verdict whose status and proportions are set
Standing standing_of(const study::Goal& goal, const WorldVerdict& verdict) {
  const BoundedProportion& claimed = judged_rate(goal, verdict);
  const double wanted = study::demanded_proportion(goal);
  Standing standing{.status = rank_of(verdict.status),
                    .bound = logit_difference(claimed.low, wanted),
                    .observed = observed_margin(claimed, wanted)};
  if (!goal.machines) return standing;
  standing.bound_of_moves = logit_difference(verdict.moves.low, goal.moves);
  standing.observed_of_moves = observed_margin(verdict.moves, goal.moves);
  return standing;
}

/// Judges a claim: one goal in one setting.
/// @param worlds [world] counts of the moves in each world, in each of which the claim must hold; a single
/// element without worlds
/// @param points, parts as for judge_goals()
ClaimVerdict judge_claim(const study::Goal& goal, std::span<const measures::MoveCounts> worlds,
                         std::size_t points, std::size_t parts) {
  const Confidences confidence(goal, points, parts * worlds.size());
  ClaimVerdict verdict;
  for (const measures::MoveCounts& world : worlds) {
    const WorldVerdict one = judge_world(goal, world, confidence);
    const bool first = verdict.worlds.empty();
    verdict.moves = first ? one.moves : lowest(verdict.moves, one.moves);
    verdict.machines = first ? one.machines : lowest(verdict.machines, one.machines);
    verdict.without_miss = first ? one.without_miss : lowest(verdict.without_miss, one.without_miss);
    verdict.machines_meeting += one.machines_meeting;
    verdict.machines_without_miss += one.machines_without_miss;
    verdict.worlds.push_back(one);
  }
  const double wanted = study::demanded_proportion(goal);
  const BoundedProportion& judged = judged_rate(goal, verdict);
  verdict.status = status_of(judged, wanted);
  verdict.standing = standing_of(goal, verdict);
  return verdict;
}

}  // namespace

int rank_of(Status status) {
  switch (status) {
    case Status::missed:
      return 0;
    case Status::undecided:
      return 1;
    case Status::met:
      break;
  }
  return 2;
}

BoundedProportion lowest(const BoundedProportion& a, const BoundedProportion& b) {
  return {std::fmin(a.value, b.value), std::min(a.low, b.low), std::min(a.high, b.high)};
}

std::string_view text_of(Status status) {
  switch (status) {
    case Status::met:
      return "met";
    case Status::missed:
      return "missed";
    case Status::undecided:
      break;
  }
  return "undecided";
}

double logit_difference(double a, double b) {
  if (a == b) return 0.0;
  const auto logit = [](double proportion) { return std::log(proportion / (1.0 - proportion)); };
  return logit(a) - logit(b);
}

bool operator<(const Standing& a, const Standing& b) {
  const auto in_order = [](const Standing& one) {
    return std::tie(one.status, one.bound, one.observed, one.bound_of_moves, one.observed_of_moves,
                    one.earliness);
  };
  return in_order(a) < in_order(b);
}

Standing standing_of(const BoundedProportion& proportion) {
  constexpr double even = 0.5;  // its logit is 0
  return {.bound = logit_difference(proportion.low, even), .observed = observed_margin(proportion, even)};
}

ClaimVerdict judge_goal(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points,
                        std::size_t parts) {
  ClaimVerdict verdict = judge_claim(goal, {&counts, 1}, points, parts);
  verdict.worlds.clear();
  return verdict;
}

Verdict judge_goals(std::span<const study::Goal> goals, std::span<const measures::CellCounts> counts,
                    std::size_t points, std::size_t parts) {
  Verdict verdict;
  for (std::size_t goal = 0; goal < goals.size(); ++goal) {
    const std::size_t settings = counts[goal].settings();
    for (std::size_t setting = 0; setting < settings; ++setting) {
      ClaimVerdict& claim = verdict.claims.emplace_back(
          judge_claim(goals[goal], counts[goal].worlds_in(setting), points, parts * goals.size() * settings));
      claim.goal = goal;
      claim.setting = setting;
      if (counts[goal].shape().worlds == 0) claim.worlds.clear();
    }
  }
  static_cast<ClaimVerdict&>(verdict) = *std::ranges::min_element(verdict.claims, is_worse);
  return verdict;
}

const ClaimVerdict& worst_where(const Verdict& verdict,
                                const std::function<bool(const ClaimVerdict&)>& is_asked) {
  const ClaimVerdict* worst = nullptr;
  for (const ClaimVerdict& claim : verdict.claims)
    if (is_asked(claim) && (worst == nullptr || is_worse(claim, *worst))) worst = &claim;
  return *worst;
}

const ClaimVerdict& worst_of_goal(const Verdict& verdict, std::size_t goal) {
  return worst_where(verdict, [goal](const ClaimVerdict& claim) { return claim.goal == goal; });
}

std::vector<std::size_t> worst_worlds_first(const study::Goal& goal, const ClaimVerdict& verdict) {
  std::vector<std::size_t> order(verdict.worlds.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto known = [](double rate) { return std::isnan(rate) ? 2.0 : rate; };  // without trials: the last
  const auto rate = [&](std::size_t world) {
    const WorldVerdict& one = verdict.worlds[world];
    return goal.machines ? std::pair(known(one.machines.value), known(one.moves.value))
                         : std::pair(known(one.moves.value), 0.0);
  };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return rate(a) < rate(b); });
  return order;
}

std::vector<std::size_t> worlds_that(Status status, const ClaimVerdict& verdict) {
  std::vector<std::size_t> worlds;
  for (std::size_t world = 0; world < verdict.worlds.size(); ++world) {
    if (verdict.worlds[world].status == status) worlds.push_back(world);
  }
  return worlds;
}

}  // namespace zerocount::goal
