#pragma once

#include <functional>
#include <string>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount::reading {

/// Reports each drawn parameter of the trials `rows` whose value the table of parameters does not allow:
/// "/trial/input/NAME: trial T: it is V; expected RANGE".
void check_inputs(const StudyFile& file, const study::Study& study, layout::RowRange rows,
                  const std::function<void(std::string problem)>& report);

}  // namespace zerocount::reading
