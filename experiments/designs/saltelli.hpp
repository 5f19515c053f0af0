#pragma once

#include <cstddef>
#include <cstdint>

namespace zerocount::designs {

/// The radial design from which Sobol' indices are estimated (Saltelli, Annoni, Azzini, Campolongo, Ratto &
/// Tarantola, "Variance based sensitivity analysis of model output", Comput. Phys. Commun. 181, 2010).
///
/// With k factors, the trials r(k + 2) … r(k + 2) + k + 1 are row r: first A, which is Monte-Carlo trial r in
/// every factor; then B, which is Monte-Carlo trial 2⁵⁵ + r in every factor; then, for j = 0 … k − 1, A with
/// factor j from B. The rows are independent, and additional rows do not change earlier ones.

/// Trials in a row: k + 2.
constexpr std::uint64_t saltelli_row_length(std::size_t factors) {
  return static_cast<std::uint64_t>(factors) + 2;
}

/// The Monte-Carlo trial from which trial `index` (at most 2⁵³) takes factor `factor`, 0 ≤ factor < factors.
constexpr std::uint64_t saltelli_source(std::uint64_t index, std::size_t factor, std::size_t factors) {
  constexpr std::uint64_t second_sample = std::uint64_t{1} << 55;  // larger than every trial index of a study
  const std::uint64_t row = index / saltelli_row_length(factors);
  const std::uint64_t place = index % saltelli_row_length(factors);
  const bool from_b = place == 1 || place == factor + 2;
  return from_b ? second_sample + row : row;
}

}  // namespace zerocount::designs
