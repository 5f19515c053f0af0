#pragma once

#include "core/trial/parameters.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::study {

/// Completes the parameters of a trial after all numbers are set in the manifest's units: converts gains from
/// SI units with the trial's sample time and encoder, and sets the resolution of a linear axis's coarse
/// encoder to that of the fine one if it is not given.
void complete_trial(const parameters::StudyUnits& units, trial::TrialParameters& trial);

}  // namespace zerocount::study
