#include "analysis/comparison/point_trials.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace zerocount {

PointTrials gather_trials(std::span<const MoveOutcome> outcomes, std::int64_t moves) {
  PointTrials result;
  result.trials = std::ssize(outcomes) / moves;
  result.moves = moves;
  for (auto move = outcomes.begin(); move != outcomes.end(); move += moves) {
    const std::span<const MoveOutcome> trial(move, move + moves);
    result.zero_count.push_back(succeeded(trial));
    result.arrived.push_back(has_arrived(trial));
    result.stable.push_back(was_stable(trial));
    double jerks = 0.0;
    for (auto one = move; one != move + moves; ++one) {
      result.settling_time.push_back(one->arrived ? one->settling_time
                                                  : std::numeric_limits<double>::quiet_NaN());
      jerks += static_cast<double>(one->jerk_count);
      add_move(result.undecided, *one);
    }
    result.jerks.push_back(jerks);
  }
  return result;
}

PointTrials read_point_trials(const StudyFile& file, std::int64_t point) {
  const std::int64_t trials = file.header().trials;
  return gather_trials(file.outcomes({point * trials, trials}), file.moves());
}

PointTrials first_trials(const PointTrials& all, std::int64_t trials) {
  PointTrials some = all;
  some.trials = std::min(trials, all.trials);
  const auto count = static_cast<std::size_t>(some.trials);
  some.zero_count.resize(count);
  some.arrived.resize(count);
  some.stable.resize(count);
  some.settling_time.resize(count * static_cast<std::size_t>(all.moves));
  some.jerks.resize(count);
  return some;
}

const std::vector<bool>& qualities(const PointTrials& trials, GateQuantity proportion) {
  if (proportion == GateQuantity::arrival) return trials.arrived;
  return proportion == GateQuantity::stability ? trials.stable : trials.zero_count;
}

std::vector<double> settling_times(const PointTrials& trials) {
  std::vector<double> means;
  for (auto move = trials.settling_time.begin(); move != trials.settling_time.end(); move += trials.moves) {
    double sum = 0.0;
    int count = 0;
    std::for_each(move, move + trials.moves, [&](double time) {
      if (std::isnan(time)) return;
      sum += time;
      ++count;
    });
    means.push_back(count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN());
  }
  return means_by_rig(means, trials.rigs);
}

std::vector<double> means_by_rig(std::span<const double> values, std::int64_t rigs) {
  const auto clusters = rigs > 0 ? static_cast<std::size_t>(rigs) : values.size();
  std::vector<double> means;
  for (std::size_t cluster = 0; cluster < clusters; ++cluster) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = cluster; i < values.size(); i += clusters) {
      if (std::isnan(values[i])) continue;
      sum += values[i];
      count += 1.0;
    }
    if (count > 0.0) means.push_back(sum / count);
  }
  return means;
}

std::vector<double> slowest_settling_times(const PointTrials& trials) {
  std::vector<double> slowest;
  for (auto move = trials.settling_time.begin(); move != trials.settling_time.end(); move += trials.moves) {
    double most = 0.0;
    std::for_each(move, move + trials.moves, [&](double time) {
      most = std::isnan(time) ? std::numeric_limits<double>::infinity() : std::max(most, time);
    });
    slowest.push_back(most);
  }
  return slowest;
}

}  // namespace zerocount
