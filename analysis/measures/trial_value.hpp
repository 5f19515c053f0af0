#pragma once

#include <functional>
#include <span>

#include "core/trial/outcome.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::measures {

/// The value of a move for the statistics; NaN if it has none.
double counted_value(const layout::Measure& measure, const trial::MoveOutcome& move);

/// Whether the moves have targets where the measure needs them.
bool has_targets(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves);

/// The value of a trial, combined from the values of its moves by Measure::of_trial; 1 or 0 for a quality.
/// The settling time of a trial is that of its slowest move.
/// @param late the value of a time that was not reached; without it the value of the trial is NaN.
double value_of_trial(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves,
                      const std::function<double()>& late = {});

}  // namespace zerocount::measures
