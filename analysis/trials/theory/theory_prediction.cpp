#include "analysis/trials/theory/theory_prediction.hpp"

#include <cstddef>
#include <functional>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include "analysis/basis/text/text.hpp"
#include "core/friction/law.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::theory {

TrialPrediction predict(const trial::TrialParameters& parameters) {
  TrialPrediction prediction;
  prediction.applies =
      !is_outside_theory(parameters) && left_out_of_criteria(parameters.plant, parameters.controller).empty();
  if (!prediction.applies) return prediction;
  const friction::FrictionParameters contact =
      friction::friction_at(parameters.friction, parameters.initial.position);
  prediction.bounds =
      integral_gain_bounds(parameters.plant, contact, parameters.encoder, parameters.controller);
  const double ki = parameters.controller.ki;
  prediction.stable = ki > 0.0 && ki < prediction.bounds.stable_below;
  prediction.unstable = ki < 0.0 || ki > prediction.bounds.unstable_above;
  return prediction;
}

void PointPrediction::add(const TrialPrediction& trial) {
  ++trials;
  stable += trial.stable;
  unstable += trial.unstable;
  outside += !trial.applies;
}

PointPrediction PointPrediction::operator+(const PointPrediction& other) const {
  return {trials + other.trials, stable + other.stable, unstable + other.unstable, outside + other.outside};
}

PointPrediction prediction_of(const study::Study& study, layout::RowRange rows) {
  constexpr std::int64_t trials_of_task = 1024;
  using Rows = oneapi::tbb::blocked_range<std::int64_t>;
  const auto add = [&](const Rows& part, PointPrediction prediction) {
    for (std::int64_t row = part.begin(); row < part.end(); ++row) {
      const study::StudyTrial trial = study::study_trial(study, row / study.trials, row % study.trials);
      prediction.add(predict(trial.parameters));
    }
    return prediction;
  };
  return oneapi::tbb::parallel_reduce(Rows(rows.first, rows.end(), trials_of_task), PointPrediction{}, add,
                                      std::plus{});
}

std::vector<PointPrediction> study_predictions(const study::Study& study,
                                               std::span<const PointPrediction> known) {
  std::vector<PointPrediction> predictions(known.begin(), known.end());
  predictions.resize(static_cast<std::size_t>(study::point_count(study)));
  for (std::size_t point = 0; point < predictions.size(); ++point) {
    const std::int64_t first = static_cast<std::int64_t>(point) * study.trials;
    if (predictions[point].trials != study.trials)
      predictions[point] = prediction_of(study, {first, study.trials});
  }
  return predictions;
}

std::int64_t predicted_trials(const PointPrediction& prediction) {
  return prediction.outside == prediction.trials ? 0 : prediction.trials;
}

std::string verdict(const PointPrediction& prediction) {
  if (prediction.trials == 0) return "unknown";
  if (predicted_trials(prediction) == 0) return "not applicable";
  if (prediction.stable == prediction.trials) return "stable";
  if (prediction.unstable == prediction.trials) return "unstable";
  return fmt::format("undecided: (6) holds in {}, (7) exceeded in {}",
                     text::percentage(prediction.stable, prediction.trials),
                     text::percentage(prediction.unstable, prediction.trials));
}

std::vector<TargetStep> target_steps(const trial::CommandParameters& command) {
  std::vector<TargetStep> steps;
  for (const std::int64_t target : command.targets)
    steps.push_back({steps.empty() ? 0 : steps.back().to, target});
  return steps;
}

bool has_no_linear_loop(const trial::TrialParameters& parameters) {
  return parameters.controller.user.plugin || !parameters.command.torque.levels.empty();
}

bool is_outside_theory(const trial::TrialParameters& parameters) {
  return has_no_linear_loop(parameters) || !friction::has_spring(parameters.friction.model);
}

std::string why_outside_theory(const trial::TrialParameters& parameters) {
  if (!is_outside_theory(parameters)) return "";
  if (parameters.controller.user.plugin)
    return "the controller is a plugin, whose transfer function is not known";
  if (!parameters.command.torque.levels.empty()) return "the loop is open";
  if (friction::traits_of(parameters.friction.model).has_presliding_motion)
    return "the spring of this friction.model yields by degrees, from its full stiffness to none, not to k1";
  return fmt::format("friction.model {} has no spring, which criteria (6) and (7) are about",
                     friction::traits_of(parameters.friction.model).word);
}

LinearDrive drive_of(const trial::TrialParameters& parameters) {
  return {1.0 + parameters.dac.gain_error, parameters.amplifier.bandwidth};
}

motion::PlantParameters with_load_mode(motion::PlantParameters plant, double frequency) {
  constexpr double load_part = 0.5;       // of the inertia
  constexpr double damping_ratio = 0.01;  // of the mode
  const double inertia = plant.inertia;
  const double swinging = load_part * (1.0 - load_part) * inertia;  // of both masses against each other
  const double rate = 2.0 * std::numbers::pi * frequency;
  plant.inertia = (1.0 - load_part) * inertia;
  plant.load = {.inertia = load_part * inertia,
                .stiffness = swinging * rate * rate,
                .damping = 2.0 * damping_ratio * swinging * rate};
  return plant;
}

}  // namespace zerocount::theory
