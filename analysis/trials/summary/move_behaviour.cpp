#include "analysis/trials/summary/move_behaviour.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/encoder.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::summary {
namespace {

UpperValues upper_values(const std::vector<double>& values) {
  if (values.empty()) return {};
  return {statistics::sample_quantile(values, 0.95), std::ranges::max(values)};
}

/// The name of the goal with this index; empty if it has no name.
std::optional<std::string> name_of_goal(const study::Study& study, std::size_t goal) {
  if (study.goals.empty() || study.goals[goal].name.empty()) return std::nullopt;
  return study.goals[goal].name;
}

}  // namespace

TrialScale scale_of(const trial::TrialParameters& p) {
  TrialScale scale{loop::fine_resolution(p.encoder), -loop::lowest_torque(p.dac), {}};
  if (loop::moves_for_ever(p.command.profile.shape)) return scale;
  std::int64_t before = 0;
  for (const std::int64_t target : p.command.targets) {
    scale.steps.push_back(std::abs(static_cast<double>(target - before)));
    before = target;
  }
  return scale;
}

void BehaviourCounter::RowValues::add(const trial::MoveOutcome& move, const TrialScale& scale,
                                      bool of_other_mass) {
  const double overshoot =
      of_other_mass ? move.other_true_overshoot / scale.resolution : static_cast<double>(move.overshoot);
  const double step = scale.steps.empty() ? 0.0 : scale.steps[static_cast<std::size_t>(move.number)];
  if (step > 0.0) smallest_step = std::min(smallest_step, step);
  if (std::isfinite(overshoot)) {  // not of a move that was stopped
    overshoots.push_back(overshoot);
    lengths.push_back(overshoot * scale.resolution);
    if (step > 0.0) of_steps.push_back(overshoot / step);
  }
  ++moves;
  if (std::isfinite(move.peak_torque)) {
    peaks.push_back(move.peak_torque);
    of_ranges.push_back(move.peak_torque / scale.largest_torque);
  }
  range = std::min(range, scale.largest_torque);
  saturated += move.saturated ? 1 : 0;
  if (!std::isfinite(move.rest_torque_power) || !std::isfinite(move.rest_torque_noise)) return;
  ++at_rest;
  power += move.rest_torque_power;
  noise += move.rest_torque_noise;
  noise_of_range += move.rest_torque_noise / (scale.largest_torque * scale.largest_torque);
}

BehaviourCounter::BehaviourCounter(const study::Study& study)
    : study_(study),
      goals_(measures::move_criteria_of(study)),
      settings_(static_cast<std::size_t>(study.settings.total())),
      rows_((goals_.size() + 1) * settings_) {}

BehaviourCounter::RowValues& BehaviourCounter::row(std::size_t goal, std::int64_t setting) {
  return rows_[goal * settings_ + static_cast<std::size_t>(setting)];
}

void BehaviourCounter::add(const TrialScale& scale, std::int64_t setting,
                           std::span<const trial::MoveOutcome> moves) {
  for (const trial::MoveOutcome& move : moves) {
    bool is_asked = false;
    for (std::size_t goal = 0; goal < goals_.size(); ++goal) {
      if (!measures::asks(goals_[goal], move)) continue;
      is_asked = true;
      row(goal, setting).add(move, scale, goals_[goal].of_other_mass);
    }
    if (!is_asked) row(goals_.size(), setting).add(move, scale, false);
  }
}

std::vector<MoveBehaviour> BehaviourCounter::behaviour() const {
  std::vector<MoveBehaviour> all;
  for (std::size_t goal = 0; goal <= goals_.size(); ++goal) {
    for (std::size_t setting = 0; setting < settings_; ++setting) {
      const RowValues& values = rows_[goal * settings_ + setting];
      if (values.moves > 0) all.push_back(behaviour_of(values, goal, setting));
    }
  }
  return all;
}

MoveBehaviour BehaviourCounter::behaviour_of(const RowValues& values, std::size_t goal,
                                             std::size_t setting) const {
  MoveBehaviour one;
  one.number = goal;
  one.goal = goal < goals_.size() ? name_of_goal(study_, goal) : std::optional("no goal");
  if (!study_.settings.empty()) one.setting = study::label_of(study_.settings, setting);
  one.moves = values.moves;
  one.overshoot = upper_values(values.overshoots);
  one.overshoot_length = upper_values(values.lengths);
  one.overshoot_of_step = upper_values(values.of_steps);
  one.smallest_step = values.smallest_step;
  one.peak_torque = upper_values(values.peaks);
  one.peak_of_range = upper_values(values.of_ranges);
  one.range = values.range;
  one.saturated = static_cast<double>(values.saturated) / static_cast<double>(one.moves);
  if (values.at_rest > 0) {
    const auto moves = static_cast<double>(values.at_rest);
    one.rest = RestTorque{std::sqrt(values.power / moves), std::sqrt(values.noise / moves),
                          std::sqrt(values.noise_of_range / moves)};
  }
  return one;
}

std::vector<MoveBehaviour> behaviour_in(const reading::AllTrialsFile& file, const study::Study& study,
                                        std::int64_t point) {
  BehaviourCounter counter(study);
  const study::TrialIndices indices = study::trial_indices(study);
  const auto moves = static_cast<std::size_t>(file.moves());
  const std::int64_t trials = file.header().trials;
  const layout::RowRange rows{point * trials, trials};
  measures::visit_blocks(file, rows,
                         [&](layout::RowRange block, std::span<const trial::MoveOutcome> outcomes) {
                           const std::int64_t first = block.first - rows.first;
                           std::vector<TrialScale> scales(static_cast<std::size_t>(block.count));
                           parallel::for_each_index(scales.size(), [&](std::size_t i) {
                             const std::int64_t trial = first + static_cast<std::int64_t>(i);
                             scales[i] = scale_of(study::commanded_trial(study, point, trial).parameters);
                           });
                           for (std::size_t i = 0; i < scales.size(); ++i)
                             counter.add(scales[i], indices.setting_of(first + static_cast<std::int64_t>(i)),
                                         outcomes.subspan(i * moves, moves));
                         });
  return counter.behaviour();
}

}  // namespace zerocount::summary
