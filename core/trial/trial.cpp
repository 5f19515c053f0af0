#include "core/trial/trial.hpp"

#include "core/trial/trial_of.hpp"

namespace zerocount::trial {

TrialOutcome run_trial(const TrialParameters& parameters, const TrialObservers& observers) {
  return run_trial_of<plant::Plant>(parameters, observers);
}

}  // namespace zerocount::trial
