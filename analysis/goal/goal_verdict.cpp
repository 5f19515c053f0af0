#include "analysis/goal/goal_verdict.hpp"

#include <algorithm>

#include "analysis/statistics/clustered_proportion.hpp"
#include "analysis/statistics/rig_proportion.hpp"

namespace zerocount::goal {
namespace {

Status status_of(const BoundedProportion& proportion, double wanted) {
  if (proportion.low >= wanted) return Status::met;
  return proportion.high < wanted ? Status::missed : Status::undecided;
}

}  // namespace

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

}  // namespace zerocount::goal
