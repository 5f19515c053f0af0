#include "core/trial/trial.hpp"

#include "core/trial/trial_of.hpp"

namespace zerocount::trial {

TrialOutcome run_trial(const TrialParameters& parameters, const TrialObservers& observers) {
  return run_trial_of<plant::Plant>(parameters, observers);
}

std::optional<TrialOutcome> watch_trial(const TrialParameters& parameters, const LoopWatch& watch) {
  try {
    return follow_targets<plant::Plant>(parameters, {}, watch);
  } catch (const Interrupted&) {
    return std::nullopt;
  }
}

}  // namespace zerocount::trial
