#pragma once

#include <optional>

namespace zerocount::friction {

/// A point of the virgin curve σv(x) = ½·f(2x), with the branch law f(u) = k1·u + (k2/β)·(1 − exp(−β·u)).
struct VirginPoint {
  double travel{0.0};  ///< x, rad
  double torque{0.0};  ///< σv(x), N m
};

/// How a spring softens from k1 + k2 to its final stiffness k1.
struct Softening {
  double k2{0.0};    ///< N m/rad
  double beta{0.0};  ///< 1/rad
};

/// The softening of a spring from its initial stiffness k1 + k2 and a point of its virgin curve:
///
///     (1 − exp(−y))/y = (torque/travel − k1)/k2,   β = y/(2·travel)
///
/// Nothing unless final < torque/travel < initial.
/// @param initial, final  stiffnesses, N m/rad
std::optional<Softening> softening_from(double initial, double final, const VirginPoint& point);

/// The softening of a spring from two points of its virgin curve. With t = last.travel/first.travel, their
/// ratio has β as its only unknown, and is monotonic in it:
///
///     (1 − exp(−t·y))/(1 − exp(−y)) = (last.torque − k1·last.travel)/(first.torque − k1·first.travel)
///     β = y/(2·first.travel),   k2 = (first.torque/first.travel − k1)·y/(1 − exp(−y))
///
/// Nothing unless k1 < first.torque/first.travel, first.travel < last.travel, and the last point lies above
/// the line of slope k1 through the first one and below that through the origin and the first one.
/// @param final k1, N m/rad
std::optional<Softening> softening_through(const VirginPoint& first, const VirginPoint& last, double final);

}  // namespace zerocount::friction
