#pragma once

#include <functional>
#include <span>

#include "core/trial/outcome.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::measures {

/// The value of a move that counts in statistics; NaN where it has none.
double counted_value(const layout::Measure& measure, const trial::MoveOutcome& move);

/// Whether the moves have targets where the measure needs them.
bool has_targets(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves);

/// The value of a trial, made of those of its moves as Measure::of_trial says; of a quality 1 or 0.
/// @param late what counts for a time that is later than any; without it, NaN makes NaN.
double value_of_trial(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves,
                      const std::function<double()>& late = {});

}  // namespace zerocount::measures
