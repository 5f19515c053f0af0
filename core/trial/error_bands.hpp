#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/trial/running_measures.hpp"

namespace zerocount::trial {

/// Half widths b of the error bands |e| ≤ b for which entry time and settling time are measured.
struct ErrorBands {
  std::array<std::int64_t, max_error_bands> limits{0, 1};  ///< Half widths b of the bands, counts; increasing
  std::size_t count{2};

  std::span<const std::int64_t> values() const { return std::span(limits).first(count); }
};

/// Maximum number of tolerances of the position error in a study.
inline constexpr std::size_t max_tolerances = 8;

/// Tolerances of the position error ε for which settling times are measured: |ε| ≤ tolerance (see
/// PositionError).
struct Tolerances {
  std::array<double, max_tolerances> limits{};  ///< Tolerances, rad; increasing
  std::size_t count{0};

  std::span<const double> values() const { return std::span(limits).first(count); }
};

}  // namespace zerocount::trial
