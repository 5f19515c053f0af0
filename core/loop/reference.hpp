#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/loop/controller/control_block.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::loop {

/// How long a recorded reference with rows at these times (s) lasts, s: until its last row and one sample of
/// the controller, so that one at the controller's rate has as many samples as rows.
double record_duration(std::span<const double> times, double sample_time);

/// The reference in counts during a move from rest to rest between two targets, in the least time that the
/// limits of the profile allow:
///
/// - step: the new target at once;
/// - trapezoidal: acceleration at its limit, cruise at the velocity limit, deceleration; without the cruise
///   where the velocity limit is not reached;
/// - s_curve: trapezoidal with limited jerk, up to seven segments of constant jerk. The acceleration
///   rises and falls at the jerk limit, and stays at its own limit in between where it reaches it;
/// - sine: amplitude·sin(2π·frequency·t) about the new target, without end;
/// - a record: its position, and its last one after its end. ṙ and r̈ are central differences of its rows, on
///   one side or 0 at its ends, and straight between them; after the last row the reference stands, and both
///   are 0.
///
/// The second half of a move between two targets is the first one backwards. Source: Biagiotti & Melchiorri,
/// "Trajectory Planning for Automatic Machines and Robots", Springer 2008, sections 3.2 and 3.4.
class Reference {
 public:
  /// @param profile limits above 0.
  /// @param from, to counts.
  /// @param resolution Δx, rad per count.
  Reference(const ReferenceProfile& profile, std::int64_t from, std::int64_t to, double resolution);

  /// The reference (counts) at the time t (s) from the move's start: the nearest whole count, and where two
  /// are as near, the one towards that end of the move which is nearer in time, of a sine the one away from
  /// the target, and of a record the even one. `from` before the start, `to` from the end on.
  std::int64_t at(double t) const;

  /// ṙ and r̈ at the time t, before r is rounded to counts; from the end of the move on, and of a step, 0.
  /// Where the acceleration jumps, its value is that just after, with 1e-12 of the duration allowed for
  /// rounding.
  ReferenceMotion motion_at(double t) const;

  /// The reference (counts) before it is rounded.
  double exact_at(double t) const;

  double duration() const { return duration_; }  ///< s; infinite for a sine and a record

  double travel_time() const;  ///< s; NaN for a sine and a record, which are not at rest in the end
  bool is_sine() const { return angular_frequency_ > 0.0; }
  /// Whether it is no move between two targets.
  bool moves_for_ever() const { return is_sine() || record_ != nullptr; }

 private:
  void plan_trapezoidal(const ReferenceProfile& limits);
  void plan_s_curve(const ReferenceProfile& limits);
  double distance(double t) const;
  double velocity(double t) const;
  double acceleration(double t) const;

  std::int64_t from_;
  std::int64_t to_;
  double resolution_;  ///< rad per count
  double counts_;      ///< |to − from|
  double travel_;      ///< |to − from|, rad

  // The first half: acceleration rising for jerk_time_, constant for acceleration_time_, falling for
  // jerk_time_, and none until duration_/2. A trapezoidal move has no jerk_time_.
  double jerk_{0.0};               ///< of the rising acceleration, rad/s³
  double acceleration_{0.0};       ///< largest reached, rad/s²
  double velocity_{0.0};           ///< largest reached, rad/s
  double jerk_time_{0.0};          ///< s
  double acceleration_time_{0.0};  ///< s
  double speed_up_time_{0.0};      ///< of all three, s
  double duration_{0.0};           ///< s

  double amplitude_{0.0};          ///< of a sine, rad
  double angular_frequency_{0.0};  ///< of a sine, rad/s; 0 for another shape
  std::shared_ptr<const ReferenceRecord> record_{};
};

}  // namespace zerocount::loop
