#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "analysis/record/sliding_identification/sliding_record.hpp"

namespace zerocount::sliding_identification {

constexpr Eigen::Index balance_terms = 6;
constexpr Eigen::Index direction_term = 1;
constexpr Eigen::Index offset_term = 3;

/// The torque about a sample, and the terms on which it depends linearly while the axis slides:
///
///   u = J·a + d·Fc + cs·v + u0 + g1·sin(2π·x/pitch) + g2·cos(2π·x/pitch)
///
/// with the last two terms 0 where the record moves by less than a fiftieth of the pitch, or knows none.
/// The other terms are means with the same triangular weights over 4·smoothing samples, which turn the second
/// differences of the positions into a mean acceleration: smoothing adds no error to the balance.
struct TorqueBalance {
  /// Acceleration, direction (±1), velocity, 1, sine and cosine of 2π·x/pitch, in this order.
  Eigen::Vector<double, balance_terms> terms;
  double torque{0.0};  ///< Torque of the drive, N m or N.
};

/// Number of samples before, and also after, a sample that its torque balance uses.
inline std::size_t balance_reach(const SlidingRecord& record) {
  return 2 * record.smoothing;
}

/// The torque balance at sample k, which must be at least balance_reach() samples from both ends of the
/// record. It is computed from readings, so their errors bias a fit that uses it.
/// @param direction direction of motion, −1 or 1
TorqueBalance torque_balance(const SlidingRecord& record, std::size_t k, double direction);

}  // namespace zerocount::sliding_identification
