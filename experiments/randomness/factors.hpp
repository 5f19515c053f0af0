#pragma once

#include <string>
#include <vector>

#include "experiments/study/plan.hpp"

namespace zerocount::randomness {

/// The factors: quantities drawn anew in each trial at some design point. These are all values with a
/// distribution, except those drawn once for the study, in the order of the table of parameters; and as the
/// last factor all random numbers that a trial uses while it runs, if any. A profile is not a factor: all
/// trials use the same rotor, and `initial.position` selects the position on it.
study::TrialFactors find_factors(const study::StudyPlan& plan);

/// The names of the factors: the dotted paths of the parameters, and within_trial_factor.
std::vector<std::string> factor_names(const study::StudyPlan& plan);

}  // namespace zerocount::randomness
