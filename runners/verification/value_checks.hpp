#pragma once

#include "experiments/study/study.hpp"
#include "results/reading/study_file.hpp"
#include "runners/verification/check.hpp"

namespace zerocount::verification {

/// Checks that every input is in the range of its parameter, every measure and every jerk in the range that
/// the layout has for it, and that no time of a move is longer than the move.
void check_values(CheckReport& report, const reading::StudyFile& file, const study::Study& study);

}  // namespace zerocount::verification
