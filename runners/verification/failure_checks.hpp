#pragma once

#include "experiments/study/study.hpp"
#include "results/reading/statistics_file.hpp"
#include "runners/verification/check.hpp"

namespace zerocount::verification {

/// The sums of a file can be those of its trials, its failures have possible values and are failures, and
/// there are as many at each point as the sums say.
void check_failures(CheckReport& report, const reading::StatisticsFile& file, const study::Study& study);

}  // namespace zerocount::verification
