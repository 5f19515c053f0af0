#pragma once

#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount {

/// What the plan's trials may meet in the loop.
LoopExtras find_loop_extras(const StudyPlan& plan);

}  // namespace zerocount
