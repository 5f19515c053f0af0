#pragma once

#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The features of a study whose other members are set, from the limits of the parameters in its plan.
StudyFeatures find_features(const StudyPlan& plan, const Study& study);

}  // namespace zerocount::study
