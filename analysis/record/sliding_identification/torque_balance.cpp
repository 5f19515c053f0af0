#include "analysis/record/sliding_identification/torque_balance.hpp"

#include <cmath>
#include <numbers>

#include "core/motion/torque_course.hpp"

namespace zerocount::sliding_identification {
namespace {

/// Approximate mean drive torque over the interval from sample k to the next, N m or N.
double torque_after(const SlidingRecord& record, std::size_t k) {
  return motion::course_after(record.torque[k], 0.5 * (record.time[k + 1] - record.time[k])).now;
}

}  // namespace

TorqueBalance torque_balance(const SlidingRecord& record, std::size_t k, double direction) {
  const std::size_t h = record.smoothing;
  const auto half = static_cast<double>(2 * h);
  const double acceleration =
      (record.velocity[k + h] - record.velocity[k - h]) / (record.time[k + h] - record.time[k - h]);
  double velocity = 0.5 * (record.velocity[k - h] + record.velocity[k + h]);
  for (std::size_t i = k - h + 1; i < k + h; ++i) velocity += record.velocity[i];
  double torque = 0.0;
  for (std::size_t i = 0; i < 4 * h; ++i) {
    const double from_middle = std::abs(static_cast<double>(i) + 0.5 - half);
    torque += (half - from_middle) * torque_after(record, k - 2 * h + i);
  }
  TorqueBalance balance{{acceleration, direction, velocity / half, 1.0, 0.0, 0.0}, torque / (half * half)};
  if (record.turns) {
    const double angle = 2.0 * std::numbers::pi * (record.origin + record.position[k]) / record.pitch;
    balance.terms.tail<2>() << std::sin(angle), std::cos(angle);
  }
  return balance;
}

}  // namespace zerocount::sliding_identification
