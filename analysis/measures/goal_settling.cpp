#include "analysis/measures/goal_settling.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "experiments/study/study.hpp"

namespace zerocount::measures {

GoalSettling::GoalSettling(const CountedGoal& goal, const Shape& shape) : rigs_(shape.rigs) {
  if (goal.on.empty() && shape.conditions == 0) return;
  times_.assign(static_cast<std::size_t>(std::max<std::int64_t>(shape.conditions, 1)),
                statistics::TrialClusters(shape.rigs));
}

void GoalSettling::add(std::int64_t trial, const CountedGoal& goal,
                       std::span<const trial::MoveOutcome> moves) {
  if (times_.empty()) return;
  values_.clear();
  for (const trial::MoveOutcome& move : moves) {
    if (!asks(goal, move)) continue;
    const double time = settling_time(goal, move);
    if (!std::isnan(time)) values_.push_back(time);
  }
  const study::TrialTurns turns{std::max<std::int64_t>(rigs_, 1), std::ssize(times_)};
  times_[static_cast<std::size_t>(turns.condition_of(trial))].add_trial(turns.draw_of(trial), values_,
                                                                        asked_moves(goal, std::ssize(moves)));
}

GoalSettling& GoalSettling::operator+=(const GoalSettling& next) {
  for (std::size_t i = 0; i < times_.size(); ++i) times_[i] += next.times_[i];
  return *this;
}

bool GoalSettling::is_valid(std::int64_t moves) const {
  std::int64_t sum = 0;
  for (const statistics::TrialClusters& times : times_) {
    if (times.size() < 0 || times.size() > moves - sum) return false;
    sum += times.size();
  }
  return times_.empty() || sum == moves;
}

std::vector<MeasureStatistics> GoalSettling::statistics(double confidence) const {
  std::vector<MeasureStatistics> all;
  for (const statistics::TrialClusters& times : times_) {
    const statistics::ClusteredSample sample = times.sample();
    MeasureStatistics& one = all.emplace_back();
    one.n = sample.observed().size;
    one.moves = sample.size();
    one.min = statistics::smallest(sample.observed());
    one.max = statistics::largest(sample.observed());
    one.median = statistics::clustered_quantile(sample, 0.5, confidence);
    one.p95 = statistics::clustered_quantile(sample, 0.95, confidence);
  }
  return all;
}

}  // namespace zerocount::measures
