#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/trial/running_measures.hpp"

namespace zerocount::trial {

/// Error bands for which entry and settling are measured: |e| ≤ b.
struct ErrorBands {
  std::array<std::int64_t, max_error_bands> limits{0, 1};  ///< b, counts; increasing
  std::size_t count{2};

  std::span<const std::int64_t> values() const { return std::span(limits).first(count); }
};

/// Maximum number of tolerances of a study.
inline constexpr std::size_t max_tolerances = 8;

/// Tolerances of the position error for which settling is measured: |ε| ≤ tolerance (see PositionError).
struct Tolerances {
  std::array<double, max_tolerances> limits{};  ///< rad; increasing
  std::size_t count{0};

  std::span<const double> values() const { return std::span(limits).first(count); }
};

}  // namespace zerocount::trial
