#pragma once

#include <string>
#include <vector>

#include "experiments/study/plan.hpp"

namespace zerocount {

/// What is drawn anew in each trial, at some design point: every value that is a distribution, but for those
/// drawn once for the study, in the order of the table of parameters, and last, where there are such, all
/// numbers that a trial draws while it runs. A profile is none: all trials are on the one rotor, and
/// `initial.position` says where.
TrialFactors find_factors(const StudyPlan& plan);

/// The names of the factors: the dotted paths of the parameters, and within_trial_factor.
std::vector<std::string> factor_names(const StudyPlan& plan);

}  // namespace zerocount
