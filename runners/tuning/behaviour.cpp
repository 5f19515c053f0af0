#include "runners/tuning/behaviour.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "analysis/measures/goal_counts.hpp"
#include "analysis/measures/trial_value.hpp"
#include "analysis/parallel/parallel.hpp"
#include "analysis/statistics/quantile.hpp"
#include "analysis/text/text.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/encoder.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::tuning {
namespace {

constexpr double max_overshoot_of_step = 0.25;
constexpr double max_saturated = 0.01;
constexpr double min_phase_margin = 30.0;  // degrees
constexpr double max_noise_of_range = 0.1;

/// What the measures of a trial's moves are held against.
struct TrialScale {
  double resolution{0.0};      ///< of the fine encoder, rad
  double largest_torque{0.0};  ///< of the converter, N m
  std::vector<double> steps;   ///< [move] counts; empty for a sine
};

TrialScale scale_of(const trial::TrialParameters& p) {
  TrialScale scale{loop::fine_resolution(p.encoder), -loop::lowest_torque(p.dac), {}};
  if (p.command.profile.shape == loop::ReferenceShape::sine) return scale;
  std::int64_t before = 0;
  for (const std::int64_t target : p.command.targets) {
    scale.steps.push_back(std::abs(static_cast<double>(target - before)));
    before = target;
  }
  return scale;
}

/// The moves of one row.
struct RowValues {
  std::vector<double> overshoots, lengths, of_steps, peaks, of_ranges;
  std::int64_t moves{0};
  std::int64_t saturated{0};
  double smallest_step{std::numeric_limits<double>::infinity()};
  double range{std::numeric_limits<double>::infinity()};
  double power{0.0}, noise{0.0}, noise_of_range{0.0};  ///< sums of squares
  std::int64_t at_rest{0};

  void add(const trial::MoveOutcome& move, const TrialScale& scale) {
    const auto overshoot = static_cast<double>(move.overshoot);
    overshoots.push_back(overshoot);
    lengths.push_back(overshoot * scale.resolution);
    const double step = scale.steps.empty() ? 0.0 : scale.steps[static_cast<std::size_t>(move.number)];
    if (step > 0.0) {
      of_steps.push_back(overshoot / step);
      smallest_step = std::min(smallest_step, step);
    }
    ++moves;
    if (std::isfinite(move.peak_torque)) {  // not of a move that was stopped
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
};

UpperValues upper_values(const std::vector<double>& values) {
  if (values.empty()) return {};
  return {statistics::sample_quantile(values, 0.95), std::ranges::max(values)};
}

/// Counts the moves of trials by goal and condition.
class BehaviourCounter {
 public:
  explicit BehaviourCounter(const study::Study& study)
      : study_(study),
        goals_(measures::asked_of_moves(study)),
        conditions_(static_cast<std::size_t>(study::condition_count(study))),
        rows_((goals_.size() + 1) * conditions_) {}

  void add(const TrialScale& scale, std::int64_t condition, std::span<const trial::MoveOutcome> moves) {
    for (const trial::MoveOutcome& move : moves) {
      bool is_asked = false;
      for (std::size_t goal = 0; goal < goals_.size(); ++goal) {
        if (!measures::asks(goals_[goal], move)) continue;
        is_asked = true;
        row(goal, condition).add(move, scale);
      }
      if (!is_asked) row(goals_.size(), condition).add(move, scale);
    }
  }

  std::vector<MoveBehaviour> behaviour() const {
    std::vector<MoveBehaviour> all;
    for (std::size_t goal = 0; goal <= goals_.size(); ++goal) {
      for (std::size_t condition = 0; condition < conditions_; ++condition) {
        const RowValues& values = rows_[goal * conditions_ + condition];
        if (values.moves > 0) all.push_back(behaviour_of(values, goal, condition));
      }
    }
    return all;
  }

 private:
  RowValues& row(std::size_t goal, std::int64_t condition) {
    return rows_[goal * conditions_ + static_cast<std::size_t>(condition)];
  }

  MoveBehaviour behaviour_of(const RowValues& values, std::size_t goal, std::size_t condition) const {
    MoveBehaviour one;
    one.number = goal;
    one.goal = goal < goals_.size() ? goal_name(study_, {goal, condition}) : std::optional("no goal");
    one.condition = condition_name(study_, {goal, condition});
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

  const study::Study& study_;
  std::vector<measures::CountedGoal> goals_;
  std::size_t conditions_;
  std::vector<RowValues> rows_;  ///< [goal, then moves that none asks][condition]
};

/// Lets the motion at rest be measured within what the goals allow, unless the study measures it.
void measure_motion(const study::Study& study, trial::TrialParameters& p) {
  if (p.verdict.motion) return;
  p.verdict.motion = true;
  for (const study::Goal& goal : study.goals) {
    const double band = goal.tolerance ? std::ceil(*goal.tolerance / loop::fine_resolution(p.encoder))
                                       : static_cast<double>(goal.band);
    p.verdict.rest_band = std::max(p.verdict.rest_band, band);
  }
}

/// " of goal 'large' under condition loaded", as far as there are several.
std::string text_of_row(const MoveBehaviour& row, const study::Study& study) {
  const bool is_asked = row.number < study.goals.size();
  std::string text;
  if (!is_asked && !study.goals.empty()) text = " that no goal is about";
  if (is_asked && study.goals.size() > 1 && row.goal) text = fmt::format(" of goal '{}'", *row.goal);
  return text + (row.condition ? fmt::format(" under condition {}", *row.condition) : std::string());
}

/// The largest overshoot that stays within the band of the row's goal, counts.
double overshoot_in_band(const MoveBehaviour& row, const study::Study& study) {
  if (row.number >= study.goals.size()) return 1.0;
  const study::Goal& goal = study.goals[row.number];
  if (!goal.tolerance) return std::max(static_cast<double>(goal.band), 1.0);
  return *goal.tolerance * row.overshoot.max / row.overshoot_length.max;  // NaN without overshoot
}

void judge_overshoot(const MoveBehaviour& row, const study::Study& study, std::vector<Refusal>& found) {
  if (!(row.overshoot_of_step.p95 > max_overshoot_of_step) ||
      !(row.overshoot.p95 > overshoot_in_band(row, study)))
    return;
  // Whole counts, which overshoot is measured in.
  const double limit =
      std::floor(std::max(max_overshoot_of_step * row.smallest_step, overshoot_in_band(row, study)));
  found.push_back(
      {"overshoot",
       fmt::format("5 % of the moves{} overshoot by {:.3g} % of the step or more (from {} counts)",
                   text_of_row(row, study), 100.0 * row.overshoot_of_step.p95, row.overshoot.p95),
       row.overshoot_of_step.p95, max_overshoot_of_step, fmt::format("limits: {{overshoot: {:g}}}", limit)});
}

void judge_saturation(const MoveBehaviour& row, const study::Study& study, std::vector<Refusal>& found) {
  constexpr double part_of_range = 0.95;
  if (!(row.saturated > max_saturated)) return;
  found.push_back(
      {"saturation",
       fmt::format("the converter clips in {:.3g} % of the moves{}", 100.0 * row.saturated,
                   text_of_row(row, study)),
       row.saturated, max_saturated,
       fmt::format("limits: {{peak_torque: {}}}", text::short_number(part_of_range * row.range))});
}

void judge_noise(const MoveBehaviour& row, const study::Study& study, std::vector<Refusal>& found) {
  if (!row.rest || !(row.rest->of_range > max_noise_of_range)) return;
  const double largest = max_noise_of_range * row.range;
  found.push_back({"torque noise",
                   fmt::format("at rest after the moves{} the torque changes by {:.3g} % of the converter's "
                               "range (rms) from sample to sample, which heats the motor",
                               text_of_row(row, study), 100.0 * row.rest->of_range),
                   row.rest->of_range, max_noise_of_range,
                   fmt::format("limits: {{rest_torque_noise: {}}}, with verdict: {{motion: true}}",
                               text::short_number(largest * largest))});
}

}  // namespace

std::vector<MoveBehaviour> behaviour_in(const reading::AllTrialsFile& file, const study::Study& study) {
  BehaviourCounter counter(study);
  const study::TrialTurns turns = study::turns_of(study);
  const auto moves = static_cast<std::size_t>(file.moves());
  measures::visit_blocks(
      file, file.rows(), [&](layout::RowRange block, std::span<const trial::MoveOutcome> outcomes) {
        std::vector<TrialScale> scales(static_cast<std::size_t>(block.count));
        parallel::for_each_index(scales.size(), [&](std::size_t i) {
          const std::int64_t trial = block.first + static_cast<std::int64_t>(i);
          scales[i] = scale_of(study::study_trial(study, 0, trial).parameters);
        });
        for (std::size_t i = 0; i < scales.size(); ++i)
          counter.add(scales[i], turns.condition_of(block.first + static_cast<std::int64_t>(i)),
                      outcomes.subspan(i * moves, moves));
      });
  return counter.behaviour();
}

std::vector<MoveBehaviour> simulated_behaviour(const study::Study& study, const trials::Replicates& units,
                                               std::int64_t count, const trials::Effort& effort) {
  constexpr std::int64_t block = 16;
  const std::int64_t conditions = study::condition_count(study);
  const auto draw = [&](std::int64_t number) {
    const std::int64_t trial =
        trials::trial_of_replicate(study, units, number / conditions, number % conditions);
    trial::TrialParameters p = study::study_trial(study, units.point, trial).parameters;
    measure_motion(study, p);
    return p;
  };
  const std::vector<trial::TrialOutcome> outcomes =
      trials::results_of(std::min(count, units.count) * conditions, block, draw, effort,
                         [](const trial::TrialOutcome& outcome) { return outcome; });
  BehaviourCounter counter(study);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const auto number = static_cast<std::int64_t>(i);
    counter.add(scale_of(draw(number)), number % conditions, outcomes[i].moves);
  }
  return counter.behaviour();
}

std::vector<Refusal> refusals_of(const std::vector<MoveBehaviour>& behaviour,
                                 const std::optional<SmallestMargins>& margins, const study::Study& study) {
  std::vector<Refusal> found;
  for (const MoveBehaviour& row : behaviour) {
    judge_overshoot(row, study, found);
    judge_saturation(row, study, found);
    judge_noise(row, study, found);
  }
  if (margins && margins->stable && margins->phase < min_phase_margin)
    found.push_back({"phase margin",
                     fmt::format("the smallest phase margin is {}°", text::short_number(margins->phase)),
                     margins->phase, min_phase_margin, "tune: {margins: {phase: 30}}"});
  return found;
}

}  // namespace zerocount::tuning
