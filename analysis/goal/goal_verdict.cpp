#include "analysis/goal/goal_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/clusters/rig_proportion.hpp"

namespace zerocount::goal {
namespace {

Status status_of(const BoundedProportion& proportion, double wanted) {
  if (proportion.low >= wanted) return Status::met;
  return proportion.high < wanted ? Status::missed : Status::undecided;
}

/// The verdict on one world, or on a study without worlds.
Verdict judge_world(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points) {
  const double confidence = statistics::confidence_of_each(goal.confidence, points);
  const statistics::ClusterSums clusters = measures::clusters_of(counts);
  Verdict verdict;
  verdict.moves = {statistics::rate(counts.met, counts.moves),
                   statistics::clustered_at_least(clusters, confidence),
                   statistics::clustered_at_most(clusters, confidence)};
  verdict.rigs_without_miss =
      std::count_if(counts.rigs.begin(), counts.rigs.end(),
                    [](const statistics::RigMoves& rig) { return rig.met == rig.moves; });
  if (!goal.machines) {
    verdict.status = status_of(verdict.moves, goal.moves);
    return verdict;
  }
  const statistics::RigProportion rigs =
      statistics::rig_proportion(counts.rigs, goal.moves, *goal.machines, confidence);
  verdict.rigs_meeting = rigs.meeting;
  verdict.machines = {statistics::rate(rigs.meeting, std::ssize(counts.rigs)), rigs.low, rigs.high};
  verdict.status = status_of(verdict.machines, *goal.machines);
  return verdict;
}

Verdict judge_worlds(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points) {
  const std::vector<measures::MoveCounts> worlds = measures::in_worlds(counts);
  Verdict verdict;
  for (const measures::MoveCounts& world : worlds) {
    const Verdict one = judge_world(goal, world, points * worlds.size());
    const bool first = verdict.worlds.empty();
    verdict.moves = first ? one.moves : lowest(verdict.moves, one.moves);
    verdict.machines = first ? one.machines : lowest(verdict.machines, one.machines);
    verdict.rigs_meeting += one.rigs_meeting;
    verdict.rigs_without_miss += one.rigs_without_miss;
    verdict.worlds.push_back({one.status, one.moves, one.machines});
  }
  verdict.status =
      goal.machines ? status_of(verdict.machines, *goal.machines) : status_of(verdict.moves, goal.moves);
  return verdict;
}

}  // namespace

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

Verdict judge_goal(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points) {
  return counts.worlds > 0 ? judge_worlds(goal, counts, points) : judge_world(goal, counts, points);
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
