#include "core/loop/reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/numerics/elementary_functions.hpp"

namespace zerocount::loop {

namespace {

constexpr double rounding_of_time = 1e-12;  ///< Rounding error allowed for, as a fraction of a duration: k·T
                                            ///< and a written time differ by rounding.

double position_of(const ReferenceRecord& record, std::size_t row) {
  return record.position[row];
}

/// The mean velocity of a recorded reference between the rows a and b, rad/s.
double velocity_between(const ReferenceRecord& record, std::size_t a, std::size_t b) {
  return (record.position[b] - record.position[a]) / (record.time[b] - record.time[a]);
}

double velocity_of(const ReferenceRecord& record, std::size_t row) {
  return velocity_between(record, row > 0 ? row - 1 : row, std::min(row + 1, record.time.size() - 1));
}

double acceleration_of(const ReferenceRecord& record, std::size_t row) {
  if (row == 0 || row + 1 == record.time.size()) return 0.0;
  const double change = velocity_between(record, row, row + 1) - velocity_between(record, row - 1, row);
  return 2.0 * change / (record.time[row + 1] - record.time[row - 1]);
}

/// Value at the time t (s) of a quantity of a recorded reference, interpolated linearly between its rows.
/// @param of_row gives the quantity in a row.
template <class OfRow>
double between_rows(const ReferenceRecord& record, double t, OfRow of_row) {
  const auto after = std::upper_bound(record.time.begin(), record.time.end(), t) - record.time.begin();
  if (after == 0) return of_row(record, 0);
  const auto row = static_cast<std::size_t>(after) - 1;
  if (row + 1 == record.time.size()) return of_row(record, row);
  const double part = (t - record.time[row]) / (record.time[row + 1] - record.time[row]);
  return of_row(record, row) + part * (of_row(record, row + 1) - of_row(record, row));
}

}  // namespace

double record_duration(std::span<const double> times, double sample_time) {
  return times.empty() ? 0.0 : times.back() + sample_time;
}

Reference::Reference(const ReferenceProfile& profile, std::int64_t from, std::int64_t to, double resolution)
    : from_(from),
      to_(to),
      resolution_(resolution),
      counts_(std::abs(static_cast<double>(to) - static_cast<double>(from))),
      travel_(counts_ * resolution),
      record_(profile.shape == ReferenceShape::record ? profile.record : nullptr) {
  if (record_) {
    duration_ = std::numeric_limits<double>::infinity();
    return;
  }
  if (profile.shape == ReferenceShape::sine) {
    amplitude_ = profile.amplitude;
    angular_frequency_ = 2.0 * std::numbers::pi * profile.frequency;
    duration_ = std::numeric_limits<double>::infinity();
    return;
  }
  if (profile.shape == ReferenceShape::step || travel_ == 0.0) return;
  if (profile.shape == ReferenceShape::trapezoidal) {
    plan_trapezoidal(profile);
  } else {
    plan_s_curve(profile);
  }
  speed_up_time_ = 2.0 * jerk_time_ + acceleration_time_;
  // The mean velocity of speeding up and slowing down is half the largest. Together they take longer than a
  // cruise over the same distance by the duration of one of them.
  duration_ = speed_up_time_ + travel_ / velocity_;
}

void Reference::plan_trapezoidal(const ReferenceProfile& limits) {
  acceleration_ = limits.acceleration_limit;
  velocity_ = std::min(limits.velocity_limit, std::sqrt(acceleration_) * std::sqrt(travel_));
  acceleration_time_ = velocity_ / acceleration_;
}

void Reference::plan_s_curve(const ReferenceProfile& limits) {
  // A move without a cruise covers (largest velocity)·(time of speeding up); that time is v/a + a/j where the
  // acceleration limit a is reached, and 2√(v/j) where it is not. Solved for v:
  const double a = limits.acceleration_limit;
  const double full_jerk_time = a / limits.jerk_limit;
  const double half_root = numerics::cbrt(0.5 * travel_);
  const bool reaches_full_acceleration = travel_ >= 2.0 * a * full_jerk_time * full_jerk_time;
  const double velocity_without_cruise =
      reaches_full_acceleration
          ? 0.5 * a * (std::sqrt(full_jerk_time * full_jerk_time + 4.0 * travel_ / a) - full_jerk_time)
          : numerics::cbrt(limits.jerk_limit) * half_root * half_root;

  velocity_ = std::min(limits.velocity_limit, velocity_without_cruise);
  jerk_ = limits.jerk_limit;
  acceleration_ = std::min(a, std::sqrt(velocity_) * std::sqrt(jerk_));
  jerk_time_ = acceleration_ / jerk_;
  acceleration_time_ = std::max(0.0, velocity_ / acceleration_ - jerk_time_);
}

std::int64_t Reference::at(double t) const {
  if (record_) return static_cast<std::int64_t>(std::rint(exact_at(t)));
  if (is_sine()) return to_ + std::llround(amplitude_ / resolution_ * numerics::sin(angular_frequency_ * t));
  if (t >= duration_) return to_;
  if (t <= 0.0) return from_;
  const bool first_half = t < 0.5 * duration_;
  const double from_end = distance(first_half ? t : duration_ - t) / resolution_;
  const double counts = std::ceil(std::min(from_end, 0.5 * counts_) - 0.5);
  const auto forwards = static_cast<std::int64_t>(to_ < from_ ? -counts : counts);
  return first_half ? from_ + forwards : to_ - forwards;
}

double Reference::exact_at(double t) const {
  if (record_) return between_rows(*record_, t, position_of) / resolution_;
  if (is_sine())
    return static_cast<double>(to_) + amplitude_ / resolution_ * numerics::sin(angular_frequency_ * t);
  if (t >= duration_) return static_cast<double>(to_);
  if (t <= 0.0) return static_cast<double>(from_);
  const bool first_half = t < 0.5 * duration_;
  const double counts = std::min(distance(first_half ? t : duration_ - t) / resolution_, 0.5 * counts_);
  const double forwards = to_ < from_ ? -counts : counts;
  return first_half ? static_cast<double>(from_) + forwards : static_cast<double>(to_) - forwards;
}

double Reference::travel_time() const {
  return moves_for_ever() ? std::numeric_limits<double>::quiet_NaN() : duration_;
}

/// The angle (rad) that the reference has covered since the start of the move at the time t (s), in the first
/// half of the move.
double Reference::distance(double t) const {
  if (t < jerk_time_) return jerk_ * t * t * t / 6.0;
  if (t < jerk_time_ + acceleration_time_) {
    const double since_middle_of_rise = t - 0.5 * jerk_time_;
    return 0.5 * acceleration_ * since_middle_of_rise * since_middle_of_rise +
           acceleration_ * jerk_time_ * jerk_time_ / 24.0;
  }
  const double cruised = velocity_ * (t - 0.5 * speed_up_time_);
  const double until_cruise = std::max(0.0, speed_up_time_ - t);
  return cruised + jerk_ * until_cruise * until_cruise * until_cruise / 6.0;
}

ReferenceMotion Reference::motion_at(double t) const {
  if (record_) {
    const double last = record_->time.back();
    if (t > last + rounding_of_time * last) return {};
    return {between_rows(*record_, t, velocity_of), between_rows(*record_, t, acceleration_of)};
  }
  if (is_sine()) {
    const double velocity = amplitude_ * angular_frequency_;
    return {velocity * numerics::cos(angular_frequency_ * t),
            -velocity * angular_frequency_ * numerics::sin(angular_frequency_ * t)};
  }
  const double rounding = rounding_of_time * duration_;
  if (t < 0.0 || t >= duration_ - rounding) return {};
  const double direction = to_ < from_ ? -1.0 : 1.0;
  const bool first_half = t < 0.5 * duration_ - rounding;
  // The second half is the first one backwards, so just after becomes just before.
  if (first_half) {
    return {direction * velocity(t), direction * acceleration(t + rounding)};
  }
  return {direction * velocity(duration_ - t), -direction * acceleration(duration_ - t - rounding)};
}

/// Velocity ṙ of the reference (rad/s) at the time t (s), in the first half of the move, positive towards the
/// target.
double Reference::velocity(double t) const {
  if (t < jerk_time_) return 0.5 * jerk_ * t * t;
  if (t < jerk_time_ + acceleration_time_) return acceleration_ * (t - 0.5 * jerk_time_);
  const double until_cruise = std::max(0.0, speed_up_time_ - t);
  return velocity_ - 0.5 * jerk_ * until_cruise * until_cruise;
}

/// Acceleration r̈ of the reference (rad/s²) at the time t (s), in the first half of the move, positive
/// towards the target.
double Reference::acceleration(double t) const {
  if (t < jerk_time_) return jerk_ * t;
  if (t < jerk_time_ + acceleration_time_) return acceleration_;
  return jerk_ * std::max(0.0, speed_up_time_ - t);
}

}  // namespace zerocount::loop
