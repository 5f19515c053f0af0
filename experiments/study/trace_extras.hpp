#pragma once

#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The optional columns of the plan's traces. A pure delay needs none: the motor torque is then the commanded
/// torque of an earlier sample.
TraceExtras find_trace_extras(const StudyPlan& plan);

}  // namespace zerocount::study
