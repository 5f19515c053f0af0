#pragma once

#include <optional>

#include <boost/container/small_vector.hpp>

#include "core/friction/parameters.hpp"
#include "core/friction/presliding/presliding_formulas.hpp"

namespace zerocount::friction {

/// A point of the virgin curve σv(x) = ½·f(2x), with the branch law f(u) = k1·u + (k2/β)·(1 − exp(−β·u)).
struct VirginPoint {
  double travel{0.0};  ///< x, rad
  double torque{0.0};  ///< σv(x), N m
};

/// Parameters by which a spring softens from k1 + k2 to its final stiffness k1.
struct Softening {
  double k2{0.0};    ///< N m/rad
  double beta{0.0};  ///< 1/rad
};

/// The softening of a spring from its initial stiffness k1 + k2 and a point of its virgin curve:
///
///     (1 − exp(−y))/y = (torque/travel − k1)/k2,   β = y/(2·travel)
///
/// The result is empty unless final < torque/travel < initial.
/// @param initial, final  stiffnesses, N m/rad
std::optional<Softening> softening_from(double initial, double final, const VirginPoint& point);

/// The softening of a spring from two points of its virgin curve. With t = last.travel/first.travel, the
/// ratio of the two points has β as its only unknown, and is monotonic in it:
///
///     (1 − exp(−t·y))/(1 − exp(−y)) = (last.torque − k1·last.travel)/(first.torque − k1·first.travel)
///     β = y/(2·first.travel),   k2 = (first.torque/first.travel − k1)·y/(1 − exp(−y))
///
/// The result is empty unless k1 < first.torque/first.travel, first.travel < last.travel, and the last point
/// lies above the line of slope k1 through the first point and below the line through the origin and the
/// first point.
/// @param final k1, N m/rad
std::optional<Softening> softening_through(const VirginPoint& first, const VirginPoint& last, double final);

using SpringBranch = SpringBranchOf<double>;

/// Torque (N m) of the branch at the elongation x (rad).
double torque_on(const SpringBranch& branch, double x);

/// Tangent stiffness dσ/dx (N m/rad) of the branch at the elongation x (rad): from k1 + k2 down to k1.
double stiffness_on(const SpringBranch& branch, double x);

/// The travel u ≥ 0 (rad) along a branch at which f(u) = k1·u + (k2/β)·(1 − exp(−βu)), the torque gained,
/// equals `torque` ≥ 0 (N m).
double inverse_branch_law(const FrictionParameters& friction, double torque);

/// The elongation (rad) at which the virgin curve carries `torque` (N m, either sign).
double virgin_elongation(const FrictionParameters& friction, double torque);

/// The hysteretic spring of the pre-sliding model: a Preisach hysteresis with wiping-out and congruency,
/// whose state is the stack of surviving reversal points. The torque is always evaluated from the top of the
/// stack, never accumulated.
class HystereticSpring {
 public:
  struct ReversalPoint {
    double elongation;  ///< rad
    double torque;      ///< N m
  };

  explicit HystereticSpring(const FrictionParameters& friction) : friction_(friction) {}

  /// Starts a contact on the virgin curve at `elongation` (rad), unstretched or re-stuck, that last moved in
  /// `direction` (−1, 0, 1).
  void start_virgin(double elongation, int direction);

  /// Starts a contact that has been stretched slowly from virgin to `torque` (N m) and released to zero
  /// torque.
  void start_preloaded(double torque);

  double elongation() const { return elongation_; }                  ///< xs, rad
  double torque() const { return torque_on(branch_, elongation_); }  ///< σ, N m
  int direction() const { return direction_; }  ///< Sign of the last motion; 0 before any motion
  std::size_t depth() const { return stack_.size(); }
  const SpringBranch& branch() const { return branch_; }

  /// Elongation (rad) at which the present branch ends in the present direction. The branch ends at the
  /// closure of the minor loop, at −xr of the only reversal point, or at the origin if a virgin curve is run
  /// inwards. Empty on an outward virgin curve.
  std::optional<double> branch_end() const {
    if (stack_.size() >= 2) return stack_[stack_.size() - 2].elongation;
    if (stack_.size() == 1) {
      const double peak = stack_.front().elongation;
      if (direction_ * peak <= 0.0) return -peak;
    } else if (direction_ * elongation_ < 0.0) {
      return 0.0;
    }
    return std::nullopt;
  }

  /// Sets the direction of motion. A change makes the present elongation a reversal point.
  void set_direction(int direction);

  /// Moves to the elongation x (rad) and calls set_direction() there. @param torque torque on the present
  /// branch at x, N m.
  void set_direction(int direction, double x, double torque);

  /// Sets the elongation to x (rad), on the present branch short of its end.
  void place(double x) { elongation_ = x; }

  /// Moves along the present branch to x (rad), which lies ahead and not beyond branch_end(). Closes the loop
  /// if x is its end.
  void move_on_branch(double x);

  /// Moves to the nearest elongation that carries `torque` (N m) within rounding, through all branches
  /// between. The torque of a reversal point closes its loop.
  void move_to_torque(double torque);

  /// Moves on in the present direction, through all branches between, until it carries `torque` (N m). Does
  /// not move if it carries as much already.
  void move_on_to_torque(double torque);

  /// Moves forwards or backwards along the present branch, without a reversal point, until it carries
  /// `torque` (N m), which is close to the present one.
  void settle_at_torque(double torque);

  struct PointOnBranch {
    double elongation;  ///< rad
    double stiffness;   ///< Tangent stiffness, N m/rad
  };

  /// The point that move_to_torque(`torque`) would reach; `torque` (N m) differs from the present one.
  PointOnBranch point_at_torque(double torque) const;

 private:
  double travel_ahead(const SpringBranch& branch, int direction) const;
  double branch_end_torque() const;
  void select_branch();
  void close_loops();

  FrictionParameters friction_;
  /// A decaying oscillation leaves about forty points; up to there no memory is allocated.
  boost::container::small_vector<ReversalPoint, 48> stack_;
  SpringBranch branch_;
  double elongation_{0.0};
  int direction_{0};
};

/// The pre-sliding range x_b (rad): the travel of the virgin curve up to breakaway, ½·f(2·x_b) = Fs, after
/// which a contact that is loaded slowly from rest slides. It is shorter than Fs/k1, by up to the k2/(2·β·k1)
/// that the spring is stiffer at first. Infinite if k1 = 0 and the curve never reaches Fs.
double presliding_range(const FrictionParameters& friction);

}  // namespace zerocount::friction
