#pragma once

#include <optional>

#include <boost/container/small_vector.hpp>

#include "core/friction/parameters.hpp"
#include "core/friction/presliding/presliding_formulas.hpp"

namespace zerocount::friction {

/// A point of the virgin curve σv(x) = ½·f(2x), with the branch law f(u) = k1·u + (k2/β)·(1 − exp(−β·u)).
struct VirginPoint {
  double travel{0.0};  ///< Travel x from the origin of the virgin curve, rad
  double torque{0.0};  ///< Torque σv(x) of the virgin curve, N m
};

/// Parameters k2 and β by which a hysteretic spring softens from its initial stiffness k1 + k2 to its final
/// stiffness k1.
struct Softening {
  double k2{0.0};    ///< Initial stiffness minus final stiffness, N m/rad
  double beta{0.0};  ///< Rate β of softening along a branch, 1/rad
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

/// Spring torque (N m) of the hysteresis branch at the elongation x (rad).
double torque_on(const SpringBranch& branch, double x);

/// Tangent stiffness dσ/dx (N m/rad) of the hysteresis branch at the elongation x (rad): from k1 + k2 at its
/// start down to k1.
double stiffness_on(const SpringBranch& branch, double x);

/// The travel u ≥ 0 (rad) along a hysteresis branch after which the torque has changed by `torque` ≥ 0 (N m):
/// the root of k1·u + (k2/β)·(1 − exp(−βu)) = torque.
double inverse_branch_law(const FrictionParameters& friction, double torque);

/// The elongation (rad) at which the virgin curve of the spring carries `torque` (N m, either sign).
double virgin_elongation(const FrictionParameters& friction, double torque);

/// The hysteretic spring of the pre-sliding model: a Preisach hysteresis with wiping-out and congruency,
/// whose state is the stack of surviving reversal points. The torque is always evaluated from the top of the
/// stack, never accumulated.
class HystereticSpring {
 public:
  struct ReversalPoint {
    double elongation;  ///< Elongation at which the spring reversed its direction, rad
    double torque;      ///< Spring torque at the reversal, N m
  };

  explicit HystereticSpring(const FrictionParameters& friction) : friction_(friction) {}

  /// Starts a new contact, without reversal points, on the virgin curve at `elongation` (rad). The contact is
  /// unstretched or has just re-stuck.
  /// @param direction direction of its last motion: −1, 0, 1.
  void start_virgin(double elongation, int direction);

  /// Starts a contact that has been stretched slowly from its virgin state to `torque` (N m), and then
  /// released to zero torque.
  void start_preloaded(double torque);

  /// Elongation xs of the spring, rad
  double elongation() const { return elongation_; }
  /// Torque σ of the spring, N m
  double torque() const { return torque_on(branch_, elongation_); }
  int direction() const {
    return direction_;
  }  ///< Direction of the last motion: −1 or 1; 0 before any
     /// < motion
  std::size_t depth() const { return stack_.size(); }
  const SpringBranch& branch() const { return branch_; }

  /// Elongation (rad) at which the present hysteresis branch ends in the present direction. The branch ends
  /// where the minor loop closes, at −xr of the only reversal point, or at the origin if a virgin curve is
  /// run inwards. Empty on an outward virgin curve, which has no end.
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

  /// Sets the direction of motion of the elongation (−1 or 1). If the direction changes, the present
  /// elongation becomes a reversal point.
  void set_direction(int direction);

  /// Moves the spring to the elongation x (rad), and sets the direction of motion there, as
  /// set_direction(direction) does.
  /// @param torque torque on the present hysteresis branch at x, N m.
  void set_direction(int direction, double x, double torque);

  /// Sets the elongation to x (rad), which must lie on the present hysteresis branch before its end.
  void place(double x) { elongation_ = x; }

  /// Moves the spring along the present hysteresis branch to the elongation x (rad), which lies ahead and not
  /// beyond branch_end(). Closes the loop if x is the end of the branch.
  void move_on_branch(double x);

  /// Moves the spring to the nearest elongation at which it carries `torque` (N m) within rounding, through
  /// all branches in between. Reaching the torque of a reversal point closes its loop.
  void move_to_torque(double torque);

  /// Moves the spring on in the present direction, through all branches in between, until it carries `torque`
  /// (N m). Does not move it if it carries as much already.
  void move_on_to_torque(double torque);

  /// Moves the spring forwards or backwards along the present branch, without making a reversal point, until
  /// it carries `torque` (N m), which is close to the present torque.
  void settle_at_torque(double torque);

  struct PointOnBranch {
    double elongation;  ///< Elongation of the point, rad
    double stiffness;   ///< Tangent stiffness at the point, N m/rad
  };

  /// The point that move_to_torque(torque) would reach, without moving the spring.
  /// @param torque spring torque, N m, different from the present one.
  PointOnBranch point_at_torque(double torque) const;

 private:
  double travel_ahead(const SpringBranch& branch, int direction) const;
  double branch_end_torque() const;
  void select_branch();
  void close_loops();

  FrictionParameters friction_;
  /// Stack of surviving reversal points, the newest last. A decaying oscillation leaves about forty points;
  /// up to 48 no memory is allocated.
  boost::container::small_vector<ReversalPoint, 48> stack_;
  SpringBranch branch_;
  double elongation_{0.0};
  int direction_{0};
};

/// The pre-sliding range x_b (rad): the travel of the virgin curve up to breakaway, ½·f(2·x_b) = Fs, with f
/// the branch law. A contact that is loaded slowly from rest slides after this travel. It is shorter than
/// Fs/k1, by up to k2/(2·β·k1), because the spring is stiffer at first. Infinite if k1 = 0 and the curve
/// never reaches Fs.
double presliding_range(const FrictionParameters& friction);

}  // namespace zerocount::friction
