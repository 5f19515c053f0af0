#pragma once

#include <string>
#include <vector>

#include "analysis/pairs/history/run_record.hpp"

namespace zerocount::testing {

/// A run of the study "gains" on day `day` of 2026, with success rates at the points a and b of 200 trials
/// and the settling time at a.
history::RunRecord run_of_day(int day, double rate_a, double rate_b = 0.5, double arrival_time = 0.03);

/// Adds to a run the comparison with a baseline of the last day of 2025, whose success rates are 0.5.
/// @param p p-value of the comparison
void compare_with_baseline(history::RunRecord& run, double p);

}  // namespace zerocount::testing
