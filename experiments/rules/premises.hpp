#pragma once

#include <vector>

#include "experiments/study/features.hpp"
#include "experiments/study/plan.hpp"

namespace zerocount::rules {

/// Lists the effects of a real axis that are absent by default. An effect is considered where
/// one of its parameters can differ from 0 in some trial of some point under some condition; otherwise it is
/// stated to be absent where the manifest gives one of them.
std::vector<study::Premise> premises_of(const study::StudyPlan& plan);

}  // namespace zerocount::rules
