#pragma once

#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The loop effects that may occur in the plan's trials.
LoopExtras find_loop_extras(const StudyPlan& plan);

}  // namespace zerocount::study
