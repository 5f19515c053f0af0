#pragma once

#include <functional>
#include <string>

#include "experiments/study/study_fwd.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/trial_tables.hpp"

namespace zerocount::reading {

using ReportInput = std::function<void(std::string problem)>;

/// Reports each drawn parameter of the trials whose value the table of parameters does not allow:
/// "/trial/input/NAME: trial T: it is V; expected RANGE".
void check_inputs(const TrialTables& trials, const study::Study& study, layout::RowRange positions,
                  const ReportInput& report);

}  // namespace zerocount::reading
