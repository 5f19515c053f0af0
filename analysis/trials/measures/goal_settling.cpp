#include "analysis/trials/measures/goal_settling.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "experiments/study/study.hpp"

namespace zerocount::measures {

GoalSettling::GoalSettling(const MoveCriterion& criterion, const Shape& shape)
    : machines_(shape.machines), within_(criterion.within) {
  if (criterion.on.empty() && shape.settings == 0 && !within_.after_profile) return;
  times_.assign(static_cast<std::size_t>(std::max<std::int64_t>(shape.settings, 1)),
                statistics::TrialClusters(shape.machines));
  if (!within_.after_profile) return;
  time_ratios_ = times_;
  allowed_.assign(times_.size(), 0.0);
}

void GoalSettling::add(std::int64_t trial, const MoveCriterion& criterion,
                       std::span<const trial::MoveOutcome> moves) {
  if (times_.empty()) return;
  const study::TrialIndices indices{std::max<std::int64_t>(machines_, 1), std::ssize(times_)};
  const auto setting = static_cast<std::size_t>(indices.setting_of(trial));
  const auto add_to = [&](statistics::TrialClusters& clusters, auto value) {
    values_.clear();
    for (const trial::MoveOutcome& move : moves)
      if (asks(criterion, move) && !std::isnan(settling_time(criterion, move)))
        values_.push_back(value(move));
    clusters.add_trial(indices.draw_of(trial), values_, asked_moves(criterion, std::ssize(moves)));
  };
  add_to(times_[setting], [&](const trial::MoveOutcome& move) { return settling_time(criterion, move); });
  if (time_ratios_.empty()) return;
  add_to(time_ratios_[setting], [&](const trial::MoveOutcome& move) {
    return settling_time(criterion, move) / allowed_time(criterion, move);
  });
  for (const trial::MoveOutcome& move : moves)
    if (asks(criterion, move)) allowed_[setting] = std::max(allowed_[setting], allowed_time(criterion, move));
}

GoalSettling& GoalSettling::operator+=(const GoalSettling& next) {
  for (std::size_t i = 0; i < times_.size(); ++i) times_[i] += next.times_[i];
  for (std::size_t i = 0; i < time_ratios_.size(); ++i) {
    time_ratios_[i] += next.time_ratios_[i];
    allowed_[i] = std::max(allowed_[i], next.allowed_[i]);
  }
  return *this;
}

bool GoalSettling::is_valid(std::int64_t moves) const {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < time_ratios_.size(); ++i)
    if (time_ratios_[i].size() != times_[i].size()) return false;
  for (const statistics::TrialClusters& times : times_) {
    if (times.size() < 0 || times.size() > moves - sum) return false;
    sum += times.size();
  }
  return times_.empty() || sum == moves;
}

std::vector<SettlingTimes> GoalSettling::statistics(double confidence) const {
  std::vector<SettlingTimes> all;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const statistics::ClusteredSample sample = times_[i].sample();
    MeasureStatistics& one = all.emplace_back().times;
    one.n = sample.observed().size;
    one.moves = sample.size();
    one.min = statistics::smallest(sample.observed());
    one.max = statistics::largest(sample.observed());
    one.median = statistics::clustered_quantile(sample, 0.5, confidence);
    one.p95 = statistics::clustered_quantile(sample, 0.95, confidence);
    all.back().allowed = allowed_.empty() ? within_.time : allowed_[i];
    all.back().time_ratio =
        lateness(time_ratios_.empty()
                     ? one.p95.value / within_.time
                     : statistics::clustered_quantile(time_ratios_[i].sample(), 0.95, confidence).value);
  }
  return all;
}

}  // namespace zerocount::measures
