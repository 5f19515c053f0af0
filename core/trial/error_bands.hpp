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

}  // namespace zerocount::trial
