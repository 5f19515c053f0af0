#pragma once

#include "analysis/document/description.hpp"
#include "analysis/experiment_design/experiment_design.hpp"

namespace zerocount::experiment_design {

/// What to record, what to expect of it on which machines, and how to identify it.
document::Description<ExperimentDesign> design_description();

}  // namespace zerocount::experiment_design
