#pragma once

#include "core/trial/parameters.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount {

/// Completes the parameters of a trial after all numbers are set in the manifest's units: converts gains from
/// SI units with the trial's sample time and encoder, and sets the resolution of a linear axis's coarse
/// encoder to that of the fine one if it is not given.
void complete_trial(const StudyUnits& units, TrialParameters& trial);

}  // namespace zerocount
