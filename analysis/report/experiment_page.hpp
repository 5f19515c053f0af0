#pragma once

#include "analysis/experiment_design/experiment_design.hpp"
#include "analysis/report/page.hpp"

namespace zerocount::report {

/// A page on a designed experiment: a figure of the torque and of the readings that the median machine would
/// give, and the answer as text.
ReportPage experiment_page(const experiment_design::ExperimentDesign& design);

}  // namespace zerocount::report
