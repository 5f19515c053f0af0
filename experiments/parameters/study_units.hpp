#pragma once

#include <array>
#include <string>
#include <string_view>

namespace zerocount::parameters {

/// Kind of positioning axis. The equations are the same, with position (m) for angle (rad), force (N) for
/// torque (N m) and mass (kg) for moment of inertia (kg m²).
enum class AxisKind { rotary, linear };

/// Unit of the gains in a manifest.
enum class GainUnits {
  count,  ///< gains of the sampled control, per count and sample: N m/count
  /// Gains of the continuous control, independent of sample rate and encoder: N m/rad, N m/(rad s), N m
  /// s/rad.
  si
};

/// Unit of the targets in a manifest.
enum class TargetUnits {
  counts,  ///< target positions are counts of the fine encoder
  si       ///< rad, or m; a target becomes the nearest count of the trial's fine encoder
};

/// The manifest's choices (kind of axis, units of gains, units of targets) that determine the units of a
/// study's parameters and results.
struct StudyUnits {
  AxisKind axis{AxisKind::rotary};
  GainUnits gains{GainUnits::count};
  TargetUnits targets{TargetUnits::counts};
};

/// The values of the manifest's key `axis`, in the order of AxisKind.
inline constexpr std::array<std::string_view, 2> axis_labels{"rotary", "linear"};
inline constexpr std::array<std::string_view, 2> gain_unit_labels{"count", "si"};
inline constexpr std::array<std::string_view, 2> target_unit_labels{"counts", "si"};

/// Converts the unit `rotary` of a rotary axis to an axis of this kind: m for rad, N for N m, kg for kg m^2,
/// and products of these. Units of a linear axis stay unchanged.
std::string unit_on(AxisKind axis, std::string_view rotary);

/// Replaces the placeholders of a text by the words for this kind of axis:
///
///     placeholder    rotary               linear
///     $inertia       moment of inertia    mass
///     $rotor         rotor                slide
///     $rotor_angle   rotor angle          position
///     $angle         angle                position
///     $track         rotor                travel      (what friction varies along)
///     $torque        torque               force       (also $Torque)
///     $rad, $Nm      rad, N m             m, N
std::string text_on(AxisKind axis, std::string_view text);

}  // namespace zerocount::parameters
