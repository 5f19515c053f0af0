#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::trial {

/// A measure of a move by the name of its column in files.
struct NamedMeasure {
  std::string_view name;
  double (*value)(const MoveOutcome& move);
  bool of_motion{false};    ///< only with `verdict.motion`
  bool of_position{false};  ///< only where the position error is measured (VerdictParameters::position_error)
};

/// All measures that are numbers or qualities, but for those of error bands and tolerances.
std::span<const NamedMeasure> named_measures();

/// A measure of an error band by its name before the band: "band_entry_time", "band_settling_time",
/// "band_exits".
struct NamedBandMeasure {
  std::string_view name;
  double BandOutcome::*value;
};
std::span<const NamedBandMeasure> named_band_measures();

}  // namespace zerocount::trial
