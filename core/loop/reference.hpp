#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/loop/controller/control_block.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::loop {

/// Duration of a recorded reference with rows at these times (s), s. It lasts until its last row plus one
/// sample of the controller, so that a record at the controller's rate has as many samples as rows.
double record_duration(std::span<const double> times, double sample_time);

/// The reference in counts during a move from rest to rest between two targets, in the shortest time that the
/// limits of the profile allow:
///
/// - step: the new target at once;
/// - trapezoidal: acceleration at its limit, cruise at the velocity limit, deceleration; no cruise if the
///   velocity limit is not reached;
/// - s_curve: trapezoidal with limited jerk, up to seven segments of constant jerk. The acceleration
///   rises and falls at the jerk limit, and stays at its own limit in between where it reaches it;
/// - sine: amplitude·sin(2π·frequency·t) about the new target, without end;
/// - a record: its position, and after its end the last position. ṙ and r̈ are central differences at its
///   rows, interpolated linearly between them. At the first and last row ṙ is a one-sided difference and
///   r̈ is 0. After the last row the reference stands, and both are 0.
///
/// The second half of a move between two targets is the first one backwards. Source: Biagiotti & Melchiorri,
/// "Trajectory Planning for Automatic Machines and Robots", Springer 2008, sections 3.2 and 3.4.
class Reference {
 public:
  /// Creates the reference of one move.
  /// @param profile shape and limits; the limits are above 0.
  /// @param from, to targets before and after the move, counts.
  /// @param resolution Δx, rad per count.
  Reference(const ReferenceProfile& profile, std::int64_t from, std::int64_t to, double resolution);

  /// The reference (counts) at the time t (s) from the move's start, rounded to the nearest whole count. A
  /// tie goes towards the end of the move that is nearer in time; for a sine away from the target; for a
  /// record to the even count. The reference is `from` before the start, and `to` from the end on.
  std::int64_t at(double t) const;

  /// Velocity ṙ and acceleration r̈ of the reference at the time t (s) from the move's start, before r is
  /// rounded to counts. Both are 0 from the end of the move on, and for a step. At a jump of the
  /// acceleration, the value just after the jump is given; 1e-12 of the duration is allowed for rounding.
  ReferenceMotion motion_at(double t) const;

  /// The reference (counts) at the time t (s) from the move's start, before it is rounded to a whole count.
  double exact_at(double t) const;

  /// Duration of the move, s; infinite for a sine and a record
  double duration() const { return duration_; }

  double travel_time() const;  ///< Time until the reference stands at its target, s; NaN for a sine and a
                               /// < record, which never come to rest
  bool is_sine() const { return angular_frequency_ > 0.0; }
  /// Whether the reference is a sine or a record, not a move between two targets.
  bool moves_for_ever() const { return is_sine() || record_ != nullptr; }

 private:
  void plan_trapezoidal(const ReferenceProfile& limits);
  void plan_s_curve(const ReferenceProfile& limits);
  double distance(double t) const;
  double velocity(double t) const;
  double acceleration(double t) const;

  std::int64_t from_;
  std::int64_t to_;
  double resolution_;  ///< Resolution Δx of the encoder, rad per count
  double counts_;      ///< Distance of the move, |to − from|, counts
  double travel_;      ///< Distance of the move, |to − from|, rad

  // The first half: acceleration rising for jerk_time_, constant for acceleration_time_, falling for
  // jerk_time_, and none until duration_/2. A trapezoidal move has no jerk_time_.
  double jerk_{0.0};               ///< Rate at which the acceleration of the reference rises, rad/s³
  double acceleration_{0.0};       ///< Largest acceleration that the reference reaches, rad/s²
  double velocity_{0.0};           ///< Largest velocity that the reference reaches, rad/s
  double jerk_time_{0.0};          ///< Time for which the acceleration rises at the jerk limit, s
  double acceleration_time_{0.0};  ///< Time for which the acceleration is constant, s
  double speed_up_time_{0.0};      ///< Time until the largest velocity is reached, s
  double duration_{0.0};           ///< Duration of the move, s

  double amplitude_{0.0};          ///< Duration of the move, s; infinite for a sine and a record
  double angular_frequency_{0.0};  ///< Angular frequency of a sine, rad/s; 0 for another shape
  std::shared_ptr<const ReferenceRecord> record_{};
};

}  // namespace zerocount::loop
