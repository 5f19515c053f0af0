#pragma once

#include <vector>

#include "experiments/study/study_trial.hpp"

namespace zerocount::study {

/// Completes the parameters of a trial after all numbers are set in the manifest's units: converts gains from
/// SI units with the trial's sample time and encoder, and gives the coarse encoder of a linear axis the
/// resolution of the fine one by default.
void complete_trial(const parameters::StudyUnits& units, trial::TrialParameters& trial);

/// Sets the targets of a sequence, and StudyTrial::target_positions. @param numbers [slot of the plan]
void set_targets(const Study& study, const std::vector<double>& numbers, StudyTrial& trial);

/// Targets in SI units become the nearest counts of the fine encoder of a trial that is complete otherwise.
void complete_targets(StudyTrial& trial);

}  // namespace zerocount::study
