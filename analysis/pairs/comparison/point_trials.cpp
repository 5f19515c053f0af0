#include "analysis/pairs/comparison/point_trials.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/trials/measures/trial_value.hpp"

namespace zerocount::comparison {
namespace {

/// Adds trials to the counts of a goal.
/// @param first index of the first of these trials at its design point
/// @param moves number of moves of each trial
/// @param outcomes [trial][move], flattened
void add_to_goal(GoalTrials& goal, std::int64_t first, std::int64_t moves,
                 std::span<const trial::MoveOutcome> outcomes) {
  for (auto move = outcomes.begin(); move != outcomes.end(); move += moves) {
    goal.moves_in_goal.push_back(
        static_cast<double>(count_moves(goal.counts, goal.criterion, first++, {move, move + moves})));
  }
}

/// Appends the settling times of the moves that the goal judges, s; infinity for a move that does not settle.
void add_goal_times(std::vector<double>& times, const GoalTrials& goal,
                    std::span<const trial::MoveOutcome> outcomes) {
  for (const trial::MoveOutcome& move : outcomes) {
    if (!measures::asks(goal.criterion, move)) continue;
    const double time = measures::settling_time(goal.criterion, move);
    times.push_back(std::isnan(time) ? std::numeric_limits<double>::infinity() : time);
  }
}

PointTrials empty_trials(std::int64_t moves, const AlsoRead& also, const layout::MeasureTable& table) {
  PointTrials trials;
  static_cast<AlsoRead&>(trials) = also;
  trials.moves = moves;
  trials.table = &table;
  return trials;
}

/// Adds the compared values of further trials.
/// @param outcomes outcomes of all their moves, [trial][move], flattened
void add_trials(PointTrials& trials, std::span<const trial::MoveOutcome> outcomes) {
  for (GoalTrials& goal : trials.required) add_to_goal(goal, trials.trials, trials.moves, outcomes);
  for (GoalTrials& goal : trials.judged) {
    add_to_goal(goal, trials.trials, trials.moves, outcomes);
    add_goal_times(trials.values[goal.settling_time()], goal, outcomes);
  }
  trials.trials += std::ssize(outcomes) / trials.moves;
  std::vector<GateMeasure> gathered = gate_measures(*trials.table);
  gathered.insert(gathered.end(), trials.bands.begin(), trials.bands.end());
  for (const GateMeasure& gated : gathered) {
    const layout::Measure& measure = *gated.measure;
    std::vector<double>& values = trials.values[gated.name];
    if (layout::is_quality(measure) || measure.reduction == layout::MoveReduction::sum) {
      for (auto move = outcomes.begin(); move != outcomes.end(); move += trials.moves)
        values.push_back(measures::value_of_trial(measure, {move, move + trials.moves}));
    } else {
      for (const trial::MoveOutcome& move : outcomes)
        values.push_back(measures::counted_value(measure, move));
    }
  }
  for (const trial::MoveOutcome& move : outcomes) measures::add_move(trials.undecided, move);
}

}  // namespace

PointTrials gather_trials(std::span<const trial::MoveOutcome> outcomes, std::int64_t moves,
                          const AlsoRead& also, const layout::MeasureTable& table) {
  PointTrials result = empty_trials(moves, also, table);
  add_trials(result, outcomes);
  return result;
}

PointTrials read_point_trials(const reading::AllTrialsFile& file, std::int64_t point, std::int64_t trials,
                              const AlsoRead& also) {
  PointTrials result = empty_trials(file.moves(), also, file.table());
  measures::visit_blocks(
      file, {point * file.header().trials, trials},
      [&](layout::RowRange, std::span<const trial::MoveOutcome> outcomes) { add_trials(result, outcomes); });
  return result;
}

PointTrials first_trials(const PointTrials& all, std::int64_t trials) {
  PointTrials some = all;
  some.trials = std::min(trials, all.trials);
  for (auto& [name, values] : some.values)
    values.resize(values.size() / static_cast<std::size_t>(all.trials) *
                  static_cast<std::size_t>(some.trials));
  for (GoalTrials& goal : some.judged) goal.moves_in_goal.resize(static_cast<std::size_t>(some.trials));
  return some;
}

std::vector<double> values_of_trials(const PointTrials& trials, const GateMeasure& measure) {
  const std::vector<double>& values = trials.of(measure);
  const auto width = std::ssize(values) / trials.trials;
  std::vector<double> means;
  for (auto move = values.begin(); move != values.end(); move += width) {
    double sum = 0.0;
    int count = 0;
    std::for_each(move, move + width, [&](double value) {
      if (std::isnan(value)) return;
      sum += value;
      ++count;
    });
    means.push_back(count > 0 ? sum / count : statistics::unknown);
  }
  return means;
}

std::vector<double> means_of_units(std::span<const double> values, std::int64_t machines) {
  const auto clusters = machines > 0 ? static_cast<std::size_t>(machines) : values.size();
  std::vector<double> means;
  for (std::size_t cluster = 0; cluster < clusters; ++cluster) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = cluster; i < values.size(); i += clusters) {
      if (std::isnan(values[i])) continue;
      sum += values[i];
      count += 1.0;
    }
    means.push_back(count > 0.0 ? sum / count : statistics::unknown);
  }
  return means;
}

std::vector<double> worst_of_moves(const PointTrials& trials, const GateMeasure& measure) {
  const std::vector<double>& values = trials.of(measure);
  const bool more_is_worse = !measure.measure->gate || measure.measure->gate->worse == layout::Worse::more;
  const double to_worse = more_is_worse ? 1.0 : -1.0;
  std::vector<double> worst;
  for (auto move = values.begin(); move != values.end(); move += trials.moves) {
    double most = -std::numeric_limits<double>::infinity();
    std::for_each(move, move + trials.moves, [&](double value) {
      most = std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(most, to_worse * value);
    });
    worst.push_back(to_worse * most);
  }
  return worst;
}

}  // namespace zerocount::comparison
