#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/monitor/change_martingale.hpp"
#include "analysis/monitor/monitored_measure.hpp"

namespace zerocount::monitor {

/// The change of a measure that its moves should show.
struct ChangeToSee {
  double size{0.0};                     ///< in the unit of the values
  std::vector<Direction> directions{};  ///< that are possible; empty: the measure is not judged
};

/// A change by `change` times the baseline's median (default 0.2), or by `change` of a proportion (default
/// 0.1), in the directions in which the measure can change so much. A measure is not judged if there is none,
/// its values have both signs, or its median is 0 or infinite.
ChangeToSee change_to_see(const MonitoredMeasure& measure, std::span<const double> baseline,
                          std::optional<double> change);

struct DelayQuestion {
  const MonitoredMeasure& measure;
  std::span<const double> baseline;  ///< sorted
  Direction direction;
  double size;   ///< of the change, which is there from the first value on
  double alarm;  ///< capital at which the change is seen
  std::int64_t max_values;
  std::uint64_t seed;
};

/// The number of values after which the change is seen in 90 % of 200 simulated sequences, at most
/// max_values; nothing where it takes more. Each sequence resamples the baseline (5000 of its values, if it
/// has more) and takes later values from it, with the change.
std::optional<std::int64_t> values_to_see(const DelayQuestion& question);

}  // namespace zerocount::monitor
