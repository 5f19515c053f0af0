#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/sensitivity/output_sensitivity.hpp"
#include "analysis/sensitivity/saltelli_indices.hpp"

namespace zerocount::sensitivity {

/// The trials of a point from which the sensitivity of an output comes: those that have a value, of a
/// saltelli design those whose whole row has.
struct UsedTrials {
  std::vector<std::size_t> row_starts;   ///< of the rows of a saltelli design
  std::vector<std::size_t> independent;  ///< all, or those of A and B of a saltelli design
  std::int64_t left_out{0};              ///< without a value, or in a row with one such
  std::int64_t of_rigs{0};               ///< not looked at, because they share a rig with one that was
};

/// @param values [trial], NaN where there is none.
UsedTrials used_trials(const PointInputs& point, const std::vector<double>& values);

/// The values at these places.
std::vector<double> picked(const std::vector<double>& values, const std::vector<std::size_t>& places);

/// The rows used.
SaltelliSample saltelli_sample(const PointInputs& point, const std::vector<double>& values,
                               const UsedTrials& used);

}  // namespace zerocount::sensitivity
