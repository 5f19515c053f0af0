#pragma once

#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The optional columns of the outcomes of the plan's trials.
OutcomeExtras find_outcome_extras(const StudyPlan& plan);

}  // namespace zerocount::study
