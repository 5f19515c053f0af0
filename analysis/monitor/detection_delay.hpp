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
  std::vector<double> sizes{};          ///< [class] in the unit of the values; 0 where it has no scale
  std::vector<Direction> directions{};  ///< that are possible; empty: the measure is not judged
};

/// A change by `change` times the baseline's median (default 0.2), or by `change` of a proportion (default
/// 0.1), in the directions in which the measure can change so much. A class has no scale if there is none,
/// its values have both signs, or its median is 0 or infinite; a measure is judged by the classes that have
/// one.
/// @param baseline [class] values
ChangeToSee change_to_see(const MonitoredMeasure& measure, std::span<const std::vector<double>> baseline,
                          std::optional<double> change);

struct DelayQuestion {
  const MonitoredMeasure& measure;
  std::span<const std::vector<double>> baseline;  ///< [class] sorted
  Direction direction;
  std::span<const double> sizes;  ///< [class] of the change, which is there from the first value on
  double alarm;                   ///< capital at which the change is seen
  std::int64_t max_values;
  std::uint64_t seed;
};

/// The number of values after which the change is seen in 90 % of 200 simulated sequences, at most
/// max_values; nothing where it takes more. Each sequence resamples the baseline (5000 of its values, if it
/// has more) class by class, and takes later values from it, of any class as often as it has them, with the
/// change.
std::optional<std::int64_t> values_to_see(const DelayQuestion& question);

}  // namespace zerocount::monitor
