#pragma once

#include <span>
#include <string>
#include <string_view>

namespace zerocount {

/// What the positioning axis does. The equations are the same, with a position in m for the angle in rad, a
/// force in N for the torque in N m, and a mass in kg for the moment of inertia in kg m².
enum class AxisKind { rotary, linear };

/// Unit of the gains in a manifest.
enum class GainUnits {
  count,  ///< per count and sample, as the sampled control has them: N m/count
  si  ///< those of the continuous control, whatever sample rate and encoder: N m/rad, N m/(rad s), N m s/rad
};

/// What decides the units of a study's parameters and results.
struct StudyUnits {
  AxisKind axis{AxisKind::rotary};
  GainUnits gains{GainUnits::count};
};

/// The words of the manifest's keys `axis` and `controller.units`, in the order of their values.
std::span<const std::string_view> axis_labels();
std::span<const std::string_view> gain_unit_labels();

/// The unit on an axis of this kind of a quantity that has the unit `rotary` on a rotary one: m for rad, N
/// for N m, kg for kg m^2, and what is made of these. Leaves a unit of a linear axis as it is.
std::string unit_on(AxisKind axis, std::string_view rotary);

/// A text in the words of an axis of this kind: force for torque, position for rotor angle. Names of keys and
/// columns are left as they are.
std::string text_on(AxisKind axis, std::string_view rotary);

}  // namespace zerocount
