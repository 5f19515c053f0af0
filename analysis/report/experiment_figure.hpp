#pragma once

#include "analysis/document/figure.hpp"
#include "analysis/experiment_design/experiment_design.hpp"

namespace zerocount::report {

/// The torque of a designed experiment, and the readings that the median machine would give.
document::Figure experiment_figure(const experiment_design::ExperimentDesign& design);

}  // namespace zerocount::report
