#include "analysis/goal/goal_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/clusters/rig_proportion.hpp"

namespace zerocount::goal {
namespace {

Status status_of(const BoundedProportion& proportion, double wanted) {
  if (proportion.low >= wanted) return Status::met;
  return proportion.high < wanted ? Status::missed : Status::undecided;
}

/// The confidences of the bounds of one part.
struct Confidences {
  double low;   ///< a goal that must hold in every part is met where it is met in each: no correction
  double high;  ///< it is missed where it is missed in one of the parts (Bonferroni)

  Confidences(const study::Goal& goal, std::size_t points, std::size_t parts)
      : low(statistics::confidence_of_each(goal.confidence, points)),
        high(statistics::confidence_of_each(goal.confidence, points * parts)) {}
};

/// The verdict on one world, or on a study without worlds.
Verdict judge_world(const study::Goal& goal, const measures::MoveCounts& counts,
                    const Confidences& confidence) {
  const statistics::ClusterSums clusters = measures::clusters_of(counts);
  Verdict verdict;
  verdict.moves = {statistics::rate(counts.met, counts.moves),
                   statistics::clustered_at_least(clusters, confidence.low),
                   statistics::clustered_at_most(clusters, confidence.high)};
  verdict.rigs_without_miss =
      std::count_if(counts.rigs.begin(), counts.rigs.end(),
                    [](const statistics::RigMoves& rig) { return rig.met == rig.moves; });
  if (!goal.machines) {
    verdict.status = status_of(verdict.moves, goal.moves);
    return verdict;
  }
  const auto rigs = [&](double one) {
    return statistics::rig_proportion(counts.rigs, {goal.moves, *goal.machines, one});
  };
  const statistics::RigProportion low = rigs(confidence.low);
  const double high = confidence.high == confidence.low ? low.high : rigs(confidence.high).high;
  verdict.rigs_meeting = low.meeting;
  const std::int64_t all = std::ssize(counts.rigs);
  verdict.without_miss = {statistics::rate(verdict.rigs_without_miss, all),
                          statistics::proportion_at_least(verdict.rigs_without_miss, all, confidence.low),
                          statistics::proportion_at_most(verdict.rigs_without_miss, all, confidence.high)};
  verdict.machines = {statistics::rate(low.meeting, std::ssize(counts.rigs)), low.low, high};
  verdict.status = status_of(verdict.machines, *goal.machines);
  return verdict;
}

Verdict judge_worlds(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points,
                     std::size_t parts) {
  const std::vector<measures::MoveCounts> worlds = measures::in_worlds(counts);
  const Confidences confidence(goal, points, parts * worlds.size());
  Verdict verdict;
  for (const measures::MoveCounts& world : worlds) {
    const Verdict one = judge_world(goal, world, confidence);
    const bool first = verdict.worlds.empty();
    verdict.moves = first ? one.moves : lowest(verdict.moves, one.moves);
    verdict.machines = first ? one.machines : lowest(verdict.machines, one.machines);
    verdict.without_miss = first ? one.without_miss : lowest(verdict.without_miss, one.without_miss);
    verdict.rigs_meeting += one.rigs_meeting;
    verdict.rigs_without_miss += one.rigs_without_miss;
    verdict.worlds.push_back({one.status, one.moves, one.machines});
  }
  verdict.status =
      goal.machines ? status_of(verdict.machines, *goal.machines) : status_of(verdict.moves, goal.moves);
  return verdict;
}

double logit(double proportion) {
  return std::log(proportion / (1.0 - proportion));
}

/// How far the lower bound of what the goal claims is above what it asks for.
double margin_of(const study::Goal& goal, const Verdict& verdict) {
  return goal.machines ? logit(verdict.machines.low) - logit(*goal.machines)
                       : logit(verdict.moves.low) - logit(goal.moves);
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

bool is_worse(const Verdict& one, const Verdict& other) {
  // Of claims on machines that show nothing the lower bounds of moves tell more.
  return std::tuple(rank_of(one.status), one.margin, one.moves.low) <
         std::tuple(rank_of(other.status), other.margin, other.moves.low);
}

Verdict judge_goal(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points,
                   std::size_t parts) {
  if (!counts.of_conditions.empty()) {
    std::vector<Verdict> each;
    for (const measures::MoveCounts& condition : counts.of_conditions)
      each.push_back(judge_goal(goal, condition, points, parts * counts.of_conditions.size()));
    const auto worst = std::ranges::min_element(each, is_worse);
    Verdict verdict = *worst;
    verdict.condition = static_cast<std::size_t>(worst - each.begin());
    verdict.conditions = std::move(each);
    return verdict;
  }
  Verdict verdict = counts.worlds > 0 ? judge_worlds(goal, counts, points, parts)
                                      : judge_world(goal, counts, {goal, points, parts});
  verdict.margin = margin_of(goal, verdict);
  return verdict;
}

Verdict judge_goals(std::span<const study::Goal> goals, std::span<const measures::MoveCounts> counts,
                    std::size_t points) {
  std::vector<Verdict> each;
  for (std::size_t i = 0; i < goals.size(); ++i)
    each.push_back(judge_goal(goals[i], counts[i], points, goals.size()));
  if (each.size() == 1) return each.front();
  const auto worst = std::ranges::min_element(each, is_worse);
  Verdict verdict = *worst;
  verdict.goal = static_cast<std::size_t>(worst - each.begin());
  verdict.goals = std::move(each);
  return verdict;
}

std::vector<ClaimVerdict> claims_of(const Verdict& verdict) {
  std::vector<ClaimVerdict> claims;
  const auto add = [&claims](std::size_t goal, const Verdict& of_goal) {
    if (of_goal.conditions.empty()) claims.push_back({goal, 0, &of_goal});
    for (std::size_t condition = 0; condition < of_goal.conditions.size(); ++condition)
      claims.push_back({goal, condition, &of_goal.conditions[condition]});
  };
  if (verdict.goals.empty()) add(0, verdict);
  for (std::size_t goal = 0; goal < verdict.goals.size(); ++goal) add(goal, verdict.goals[goal]);
  return claims;
}

std::vector<std::size_t> worst_worlds_first(const study::Goal& goal, const Verdict& verdict) {
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

std::vector<std::size_t> worlds_that(Status status, const Verdict& verdict) {
  std::vector<std::size_t> worlds;
  for (std::size_t world = 0; world < verdict.worlds.size(); ++world) {
    if (verdict.worlds[world].status == status) worlds.push_back(world);
  }
  return worlds;
}

}  // namespace zerocount::goal
