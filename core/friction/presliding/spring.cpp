#include "core/friction/presliding/spring.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::friction {
namespace {

/// Softening term 1 − exp(−y) of the hysteresis branch law.
double softened(double y) {
  return -numerics::expm1_of_draws(-y);
}

/// The smallest y for which the condition holds, to the last bit, by bisection.
/// @param low, high ends between which y lies; the condition is false at `low` and true at `high`.
template <class Condition>
double least_that(double low, double high, const Condition& holds) {
  return numerics::bisect(
             {.holds = high, .fails = low}, holds, [](const auto&) { return false; },
             numerics::geometric_mean)
      .holds;
}

bool is_solved(const Softening& softening) {
  return std::isfinite(softening.k2) && softening.k2 > 0.0 && std::isfinite(softening.beta) &&
         softening.beta > 0.0;
}

SpringBranch branch_from(const FrictionParameters& friction, double elongation, double torque, double sign) {
  return {elongation, torque, sign, friction.k1, friction.k2 / friction.beta, friction.beta};
}

SpringBranch virgin_branch(const FrictionParameters& friction, double sign) {
  return {0.0, 0.0, sign, friction.k1, friction.k2 / (2.0 * friction.beta), 2.0 * friction.beta};
}

/// The travel u ≥ 0 (rad) along a branch that gives the torque gain `torque` ≥ 0 (N m): k1·u +
/// softening_torque·(1 − exp(−softening_rate·u)) = torque. The law is increasing and concave, so Newton's
/// iteration from below rises to the root without passing it; it ends when it no longer rises. It starts at
/// the root for the constant stiffness of the start, or of the end, of the law, or at `at_least`: itself if
/// it is above the root.
double travel_at(const SpringBranch& branch, double torque,
                 double at_least = -std::numeric_limits<double>::infinity()) {
  const double stiffest = branch.k1 + branch.softening_torque * branch.softening_rate;
  double travel = std::max({torque / stiffest, (torque - branch.softening_torque) / branch.k1, at_least});
  for (;;) {
    const double softened = -numerics::expm1(-branch.softening_rate * travel);
    const double missing = torque - branch.k1 * travel - branch.softening_torque * softened;
    const double stiffness = branch.k1 + branch.softening_torque * branch.softening_rate * (1.0 - softened);
    const double next = travel + missing / stiffness;
    if (!(next > travel)) return travel;
    travel = next;
  }
}

}  // namespace

std::optional<Softening> softening_from(double initial, double final, const VirginPoint& point) {
  const double secant = point.torque / point.travel;
  if (!(final < secant && secant < initial)) return std::nullopt;
  const double k2 = initial - final;
  const double ratio = (secant - final) / k2;  // between 1 − y/2 and 1/y
  const double y =
      least_that((initial - secant) / k2, 1.0 / ratio, [&](double at) { return softened(at) <= ratio * at; });
  const Softening found{k2, 0.5 * y / point.travel};
  return is_solved(found) ? std::optional(found) : std::nullopt;
}

std::optional<Softening> softening_through(const VirginPoint& first, const VirginPoint& last, double final) {
  const double secant = first.torque / first.travel;
  const double rest = last.travel - first.travel;
  const double early = first.torque - final * first.travel;
  const double late = last.torque - first.torque - final * rest;
  const double below = secant * last.travel - last.torque;
  if (!(final < secant && rest > 0.0 && early > 0.0 && late > 0.0 && below > 0.0)) return std::nullopt;
  // With both sides less 1: (1 − exp(−t1·y))/(exp(y) − 1) = late/early, which is between t1 − t·t1·y/2 and
  // 1/(exp(y) − 1).
  const double t1 = rest / first.travel;
  const double ratio = late / early;
  const double high = numerics::log1p(1.0 / ratio);
  const double low = std::fmin(below / early / (t1 * (1.0 + t1)), 0.5 * high);
  const double y = least_that(
      low, high, [&](double at) { return softened(t1 * at) <= ratio * numerics::expm1_of_draws(at); });
  const Softening found{early / first.travel * y / softened(y), 0.5 * y / first.travel};
  return is_solved(found) ? std::optional(found) : std::nullopt;
}

double torque_on(const SpringBranch& branch, double x) {
  const double travel = travel_on(branch, x);
  return torque_after(branch, travel, -numerics::expm1(-branch.softening_rate * travel));
}

double stiffness_on(const SpringBranch& branch, double x) {
  return branch.k1 + branch.softening_torque * branch.softening_rate *
                         numerics::exp(-branch.softening_rate * travel_on(branch, x));
}

double inverse_branch_law(const FrictionParameters& friction, double torque) {
  return travel_at(branch_from(friction, 0.0, 0.0, 1.0), torque);
}

double virgin_elongation(const FrictionParameters& friction, double torque) {
  return std::copysign(travel_at(virgin_branch(friction, 1.0), std::abs(torque)), torque);
}

void HystereticSpring::start_virgin(double elongation, int direction) {
  stack_.clear();
  elongation_ = elongation;
  direction_ = direction;
  select_branch();
}

void HystereticSpring::start_preloaded(double torque) {
  if (torque == 0.0) return start_virgin(0.0, 0);
  const double peak = virgin_elongation(friction_, torque);
  stack_.assign(1, {peak, torque});
  direction_ = torque > 0.0 ? -1 : 1;
  elongation_ = peak + direction_ * inverse_branch_law(friction_, std::abs(torque));
  select_branch();
}

void HystereticSpring::set_direction(int direction) {
  if (direction != direction_) set_direction(direction, elongation_, torque());
}

void HystereticSpring::set_direction(int direction, double x, double torque) {
  elongation_ = x;
  if (direction == direction_) return;
  if (direction_ != 0) stack_.push_back({x, torque});
  direction_ = direction;
  select_branch();
  close_loops();
}

void HystereticSpring::move_on_branch(double x) {
  elongation_ = x;
  close_loops();
}

void HystereticSpring::move_to_torque(double torque) {
  const double now = this->torque();
  if (torque == now) return;
  set_direction(torque > now ? 1 : -1);
  move_on_to_torque(torque);
}

void HystereticSpring::move_on_to_torque(double torque) {
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * std::abs(torque);
  for (std::optional<double> end = branch_end();
       end && direction_ * (torque - branch_end_torque()) >= -rounding; end = branch_end()) {
    move_on_branch(*end);
  }
  const double here = travel_ahead(branch_, direction_);
  const double travel = travel_at(branch_, branch_.sign * (torque - branch_.torque), here);
  const double x = branch_.elongation + branch_.sign * travel;
  if (travel > here && direction_ * (x - elongation_) > 0.0) move_on_branch(x);
}

void HystereticSpring::settle_at_torque(double torque) {
  move_on_branch(elongation_ + (torque - this->torque()) / stiffness_on(branch_, elongation_));
}

HystereticSpring::PointOnBranch HystereticSpring::point_at_torque(double torque) const {
  const ReversalPoint here{elongation_, this->torque()};
  const int direction = torque > here.torque ? 1 : -1;
  const bool reverses = direction_ != 0 && direction != direction_;
  const auto point = [&](std::size_t i) { return i < stack_.size() ? stack_[i] : here; };
  std::size_t depth = stack_.size() + (reverses ? 1 : 0);
  while (depth >= 2 && direction * (torque - point(depth - 2).torque) >= 0.0) depth -= 2;
  // The virgin curve goes on beyond the mirror image of the first reversal point, where that lies ahead.
  const bool mirrored = depth == 1 && direction * point(0).torque <= 0.0;
  if (mirrored && direction * (torque + point(0).torque) >= 0.0) depth = 0;
  const SpringBranch branch =
      depth > 0 ? branch_from(friction_, point(depth - 1).elongation, point(depth - 1).torque, direction)
                : virgin_branch(friction_, torque < 0.0 ? -1.0 : 1.0);
  const double x = branch.elongation + branch.sign * travel_at(branch, branch.sign * (torque - branch.torque),
                                                               travel_ahead(branch, direction));
  return {x, stiffness_on(branch, x)};
}

/// The travel (rad) along a branch up to the present elongation, if motion in `direction` lengthens it;
/// otherwise minus infinity.
double HystereticSpring::travel_ahead(const SpringBranch& branch, int direction) const {
  return branch.sign == direction ? travel_on(branch, elongation_) : -std::numeric_limits<double>::infinity();
}

/// Spring torque σ at the end of the present hysteresis branch, branch_end(), N m.
double HystereticSpring::branch_end_torque() const {
  if (stack_.size() >= 2) return stack_[stack_.size() - 2].torque;
  return stack_.empty() ? 0.0 : -stack_.front().torque;
}

void HystereticSpring::close_loops() {
  bool closed = false;
  // With an empty stack no loop closes: a virgin curve run inwards changes sides at the origin.
  while (!stack_.empty()) {
    const std::optional<double> end = branch_end();
    if (!end || direction_ * (elongation_ - *end) < 0.0) break;
    stack_.resize(stack_.size() >= 2 ? stack_.size() - 2 : 0);
    closed = true;
  }
  if (closed || (stack_.empty() && direction_ * elongation_ >= 0.0)) select_branch();
}

void HystereticSpring::select_branch() {
  if (!stack_.empty()) {
    branch_ = branch_from(friction_, stack_.back().elongation, stack_.back().torque, direction_);
  } else if (elongation_ != 0.0) {
    branch_ = virgin_branch(friction_, elongation_ > 0.0 ? 1.0 : -1.0);
  } else {
    branch_ = virgin_branch(friction_, direction_ < 0 ? -1.0 : 1.0);
  }
}

double presliding_range(const FrictionParameters& friction) {
  const bool saturates = friction.k1 == 0.0 && friction.k2 / (2.0 * friction.beta) <= friction.breakaway;
  return saturates ? std::numeric_limits<double>::infinity()
                   : virgin_elongation(friction, friction.breakaway);
}

}  // namespace zerocount::friction
