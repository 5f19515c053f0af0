#pragma once

#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount {

/// What the sample records of the plan's trials hold beyond the columns that all have. A delay alone is none
/// of it: the torque of the motor is then that of an earlier sample.
TraceExtras find_trace_extras(const StudyPlan& plan);

}  // namespace zerocount
