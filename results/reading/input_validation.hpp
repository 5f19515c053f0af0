#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/statistics_file.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount::reading {

using ReportInput = std::function<void(std::string problem)>;

/// Reports each drawn parameter of the trials `rows` whose value the table of parameters does not allow:
/// "/trial/input/NAME: trial T: it is V; expected RANGE".
void check_inputs(const StudyFile& file, const study::Study& study, layout::RowRange rows,
                  const ReportInput& report);

/// The same of `count` of the trials that failed, from the position `first` on.
void check_inputs(const KeptTrials& failures, const study::Study& study, std::int64_t first,
                  std::int64_t count, const ReportInput& report);

}  // namespace zerocount::reading
