#pragma once

#include "experiments/study/study.hpp"
#include "results/reading/results_file.hpp"
#include "runners/verification/check.hpp"

namespace zerocount::verification {

/// Checks that every input is in the range of its parameter, every measure and every jerk in the range that
/// the layout has for it, and that no time of a move is longer than the move. If the file has sums, checks
/// that they can be those of its trials, that the kept trials failed, and that there are as many at each
/// point as the sums count.
void check_values(CheckReport& report, const reading::ResultsFile& file, const study::Study& study);

}  // namespace zerocount::verification
