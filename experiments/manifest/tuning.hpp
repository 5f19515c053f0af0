#pragma once

#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::manifest {

/// Reads `tune`. The study's goal and all parameters must be read already.
void read_tuning(const yaml::Field& field, const study::StudyPlan& plan, study::Study& study,
                 yaml::Problems& problems);

}  // namespace zerocount::manifest
