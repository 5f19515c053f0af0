#include "analysis/measures/theory_prediction.hpp"

#include <fmt/format.h>

#include "analysis/text/text.hpp"

namespace zerocount {

TrialPrediction predict(const TrialParameters& parameters) {
  TrialPrediction prediction;
  if (!parameters.command.torque.levels.empty() || !has_spring(parameters.friction.model)) {
    prediction.applies = false;
    return prediction;
  }
  const FrictionParameters contact = friction_at(parameters.friction, parameters.initial.position);
  prediction.bounds =
      integral_gain_bounds(parameters.plant, contact, parameters.encoder, parameters.controller);
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

std::int64_t predicted_trials(const TheoryPrediction& prediction) {
  return prediction.outside == prediction.trials ? 0 : prediction.trials;
}

std::string verdict(const TheoryPrediction& prediction) {
  if (prediction.trials == 0) return "unknown";
  if (predicted_trials(prediction) == 0) return "not applicable";
  if (prediction.stable == prediction.trials) return "stable";
  if (prediction.unstable == prediction.trials) return "unstable";
  return fmt::format("undecided: (6) holds in {}, (7) exceeded in {}",
                     percentage(prediction.stable, prediction.trials),
                     percentage(prediction.unstable, prediction.trials));
}

}  // namespace zerocount
