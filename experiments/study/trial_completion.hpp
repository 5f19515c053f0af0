#pragma once

#include "core/trial/parameters.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount {

/// Completes the parameters of a trial once all numbers are in their places, in the units of the manifest:
/// gains in SI units become those of the trial's sample time and encoder, and a coarse encoder of a linear
/// axis without a resolution of its own gets that of the fine one.
void complete_trial(const StudyUnits& units, TrialParameters& trial);

}  // namespace zerocount
