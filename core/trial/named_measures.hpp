#pragma once

#include <span>
#include <string_view>

namespace zerocount::trial {

/// The name of a measure of a move in files.
struct NamedMeasure {
  std::string_view name;
  bool of_motion{false};    ///< only with `verdict.motion`
  bool of_position{false};  ///< only where the position error is measured (VerdictParameters::position_error)
};

/// All measures that are numbers or qualities, but for those of error bands and tolerances.
std::span<const NamedMeasure> named_measures();

/// The names of the measures of an error band, before the band: "band_exits" of "band_exits[1]".
std::span<const std::string_view> named_band_measures();
/// The measure of a tolerance of the position error, before the tolerance.
inline constexpr std::string_view tolerance_measure = "tolerance_settling_time";

}  // namespace zerocount::trial
