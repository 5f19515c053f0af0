#pragma once

#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount {

/// What the outcomes of the plan's trials hold beyond the columns that all have.
OutcomeExtras find_outcome_extras(const StudyPlan& plan);

}  // namespace zerocount
