#pragma once

#include <cstdint>
#include <optional>

#include "analysis/statistics/proportion.hpp"

namespace zerocount::measures {

/// Where the resampling of a design point draws its random numbers.
struct BootstrapDraws {
  std::uint64_t seed{0};    ///< of the study
  std::uint32_t stream{0};  ///< the design point
};

/// How the statistics of a design point are made.
struct StatisticsOptions {
  double confidence{statistics::summary_confidence};
  std::optional<BootstrapDraws> bootstrap{};  ///< none: the bounds of means are left open
  /// Whether the trials went on until their outcomes were known well enough: claims about all axes need
  /// bounds that allow for it then.
  bool stopped_by_outcomes{false};
};

}  // namespace zerocount::measures
