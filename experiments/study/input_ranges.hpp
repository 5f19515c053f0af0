#pragma once

#include <optional>
#include <vector>

#include "core/numerics/interval.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The values that the table of parameters allows for an input column.
struct InputRange {
  numerics::Interval range;    ///< in the column's unit
  std::optional<double> none;  ///< also allowed: the value of the word "none"
};

bool contains(const InputRange& allowed, double value);

/// [input column] the ranges; empty for a study that was not made from a manifest.
std::vector<InputRange> input_ranges(const Study& study);

}  // namespace zerocount::study
