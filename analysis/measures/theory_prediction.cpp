#include "analysis/measures/theory_prediction.hpp"

#include <fmt/format.h>

#include "analysis/text/text.hpp"

namespace zerocount::measures {

TrialPrediction predict(const trial::TrialParameters& parameters) {
  TrialPrediction prediction;
  if (parameters.controller.user.plugin || !parameters.command.torque.levels.empty() ||
      !friction::has_spring(parameters.friction.model) ||
      !theory::left_out_of_criteria(parameters.plant, parameters.controller).empty()) {
    prediction.applies = false;
    return prediction;
  }
  const friction::FrictionParameters contact =
      friction::friction_at(parameters.friction, parameters.initial.position);
  prediction.bounds =
      theory::integral_gain_bounds(parameters.plant, contact, parameters.encoder, parameters.controller);
  const double ki = parameters.controller.ki;
  prediction.stable = ki > 0.0 && ki < prediction.bounds.stable_below;
  prediction.unstable = ki < 0.0 || ki > prediction.bounds.unstable_above;
  return prediction;
}

void TheoryPrediction::add(const TrialPrediction& trial) {
  ++trials;
  stable += trial.stable;
  unstable += trial.unstable;
  outside += !trial.applies;
}

TheoryPrediction TheoryPrediction::operator+(const TheoryPrediction& other) const {
  return {trials + other.trials, stable + other.stable, unstable + other.unstable, outside + other.outside};
}

std::int64_t predicted_trials(const TheoryPrediction& prediction) {
  return prediction.outside == prediction.trials ? 0 : prediction.trials;
}

std::string verdict(const TheoryPrediction& prediction) {
  if (prediction.trials == 0) return "unknown";
  if (predicted_trials(prediction) == 0) return "not applicable";
  if (prediction.stable == prediction.trials) return "stable";
  if (prediction.unstable == prediction.trials) return "unstable";
  return fmt::format("undecided: (6) holds in {}, (7) exceeded in {}",
                     text::percentage(prediction.stable, prediction.trials),
                     text::percentage(prediction.unstable, prediction.trials));
}

}  // namespace zerocount::measures
