// The kinks of the motion: where they are found in time, and what they do to the contact.

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <boost/math/tools/toms748_solve.hpp>

#include "tests/support/odeint_motion.hpp"

namespace zerocount::testing {

namespace {

using Real = OdeintMotion::Real;

constexpr Real still = 1e-17L;  // δ of the rest rule, rad
constexpr Real never = std::numeric_limits<Real>::infinity();

/// Position of the extremum of the parabola through three points.
Real vertex_of(Real x0, Real y0, Real x1, Real y1, Real x2, Real y2) {
  const Real left = (x1 - x0) * (y1 - y2);
  const Real right = (x1 - x2) * (y1 - y0);
  return x1 - ((x1 - x0) * left - (x1 - x2) * right) / (2 * (left - right));
}

}  // namespace

bool OdeintMotion::closure_ahead(Real& target) const {
  if (stack_.size() >= 2) {
    target = stack_[stack_.size() - 2].first;
    return true;
  }
  if (stack_.empty() || sign(stack_.front().first) == direction_) return false;
  target = -stack_.front().first;
  return true;
}

OdeintMotion::Guards OdeintMotion::guards(const State& y) const {
  Guards g;
  g.fill(never);
  if (sliding_) {
    g[stop] = direction_ * y[1];
    return g;
  }
  const Real sigma = spring_torque(y);
  const Real x = elongation(y);
  if (direction_ != 0 && !resting_)
    g[reversal] = direction_ * (y[1] - sign(sigma) * hardening_rate(y, sigma));
  Real target = 0;
  if (closure_ahead(target)) g[closure] = direction_ * (target - x);
  if (stack_.empty() && direction_ == -virgin_sign_) g[virgin_origin] = virgin_sign_ * x;
  // While creep is on, the driving term counts as negative beyond σ = 0: a swift passage through zero, where
  // creep stops and starts again, could otherwise hide between two points.
  const int side = creeping_ ? sign(spring_torque(state_)) : 0;
  const Real drive = (side * sign(sigma) < 0 ? -1 : 1) * driving(sigma);
  g[creep_kink] = creeping_ ? drive - y[3] : y[3] - drive;
  const Real force = sigma + plant_.presliding_damping * y[1];
  // Both conditions at once, |σ + cω| ≥ breakaway and (σ + cω)·ω > 0, as one continuous function.
  g[breakaway_up] = -std::min(force - contact_.breakaway, y[1]);
  g[breakaway_down] = -std::min(-force - contact_.breakaway, -y[1]);
  return g;
}

OdeintMotion::Crossing OdeintMotion::first_crossing(const State& end, Real length) const {
  // Guards at the ends and at three points of the cubic through the ends; what they show is then located
  // exactly.
  const State from = slopes(state_, 0);
  const State to = slopes(end, length);
  constexpr int parts = 6;
  constexpr std::array<Real, parts + 1> points{0, 0.04L, 0.25L, 0.5L, 0.75L, 0.96L, 1};
  std::array<Guards, parts + 1> g;
  g[0] = guards(state_);
  g[parts] = guards(end);
  for (int i = 1; i < parts; ++i) {
    const Real s = points[i];
    State y{};
    for (std::size_t j = 0; j < y.size(); ++j) {
      y[j] = (1 - s) * (1 - s) * (1 + 2 * s) * state_[j] + s * s * (3 - 2 * s) * end[j] +
             s * (1 - s) * length * ((1 - s) * from[j] - s * to[j]);
    }
    g[i] = guards(y);
  }
  Crossing first;
  const auto consider = [&](Event event, Real low, Real low_value, Real high) {
    if (guards(state_after(high))[event] >= 0) return;  // the cubic misled
    const Real time = locate(event, low, low_value, high);
    if (first.event == event_count || time < first.time) first = {time, event};
  };
  for (int e = 0; e < event_count; ++e) {
    const auto event = static_cast<Event>(e);
    for (int i = 1; i <= parts; ++i) {
      const Real before = g[i - 1][e];
      const Real here = g[i][e];
      if (here < 0) {
        consider(event, length * points[i - 1], before, length * points[i]);
        break;
      }
      if (i == parts || here == never || !(here < before && here <= g[i + 1][e])) continue;
      const Real vertex = vertex_of(points[i - 1], before, points[i], here, points[i + 1], g[i + 1][e]);
      if (2 * here < std::max(before, g[i + 1][e])) {
        consider(event, length * points[i - 1], before, length * vertex);
      }
    }
  }
  // A guard broken only for an instant, as by a loop that closes just before the motion turns back, shows at
  // the turning point itself.
  for (bool found = first.event != event_count; found;) {
    found = false;
    const Guards there = guards(state_after(first.time));
    for (int e = 0; e < event_count && !found; ++e) {
      if (e == first.event || !(g[0][e] > 0) || there[e] >= 0) continue;
      const Real time = locate(static_cast<Event>(e), 0, g[0][e], first.time);
      found = time < first.time;
      if (found) first = {time, static_cast<Event>(e)};
    }
  }
  return first;
}

Real OdeintMotion::locate(Event event, Real low, Real low_value, Real high) const {
  const auto guard = [&](Real time) { return time == 0 ? low_value : guards(state_after(time))[event]; };
  Real value = low == 0 ? low_value : guard(low);
  for (int halving = 0; value <= 0;
       ++halving) {  // rounding at the start: look for where the guard is truly fulfilled
    if (halving == 60) return low;
    const Real trial = low + (high - low) / 2;
    value = guard(trial);
    (value > 0 ? low : high) = trial;
  }
  std::uintmax_t iterations = 200;
  const Real high_value = guard(high);
  const auto bracket = boost::math::tools::toms748_solve(
      guard, low, high, value, high_value, boost::math::tools::eps_tolerance<Real>(60), iterations);
  return bracket.second;
}

void OdeintMotion::happen(Event event) {
  switch (event) {
    case reversal:
      return reverse();
    case closure:
      return close_loops();
    case virgin_origin:
      virgin_sign_ = -virgin_sign_;
      return;
    case creep_kink:
      creeping_ = !creeping_;
      ++events_.creep_kinks;
      return;
    case breakaway_up:
      return break_away(1);
    case breakaway_down:
      return break_away(-1);
    case stop:
      stick();
      return settle();
    case event_count:
      return;
  }
}

/// Duration (s) for which a contact with Coulomb friction stays at rest from now on, at most `longest`.
Real OdeintMotion::standing_time(Real longest) const {
  const auto excess = [this](Real time) { return std::abs(torque_at(time)) - contact_.breakaway; };
  if (excess(0) > 0) return 0;
  if (!(excess(longest) > 0)) return longest;
  std::uintmax_t iterations = 200;
  return boost::math::tools::toms748_solve(excess, Real{0}, longest,
                                           boost::math::tools::eps_tolerance<Real>(62), iterations)
      .second;
}

void OdeintMotion::settle() {
  frozen_ = resting_ = false;
  if (sliding_ || coulomb_) return;
  const Real sigma = spring_torque(state_);
  const Real rate = state_[1] - sign(sigma) * hardening_rate(state_, sigma);
  const Real acceleration = elongation_acceleration(state_);
  const bool slow = std::abs(rate) <= still * frequency_;
  const Real change = torque_.rate * (torque_.settled - torque_at(0));  // du/dt, N m/s
  resting_ = change == 0 && slow && std::abs(acceleration) <= still * frequency_ * frequency_;
  const Real calm = still * frequency_ / 1000;
  frozen_ = change == 0 && std::abs(rate) <= calm && std::abs(acceleration) <= calm * frequency_ &&
            std::abs(state_[1]) <= calm && hardening_rate(state_, sigma) <= calm;
  int moving = slow ? sign(acceleration) : sign(rate);
  if (moving == 0) moving = sign(change);
  for (const int s : {1, -1}) {
    const Real velocity = state_[1] != 0 ? s * state_[1] : s * (torque_at(0) - sigma);
    const Real force = s * (sigma + plant_.presliding_damping * state_[1]);
    if (force > contact_.breakaway && velocity > 0) return break_away(s);
  }
  if (resting_ || moving == 0) return;
  if (direction_ == 0) {
    direction_ = virgin_sign_ = moving;
  } else if (moving != direction_) {
    reverse();
  }
}

void OdeintMotion::reverse() {
  stack_.emplace_back(elongation(state_), spring_torque(state_));
  direction_ = -direction_;
  ++events_.reversals;
  if (events_.reversals > 10'000'000) throw std::runtime_error("odeint_motion: reversals do not end");
}

void OdeintMotion::close_loops() {
  const Real x = elongation(state_);
  Real target = 0;
  while (closure_ahead(target) && direction_ * (x - target) >= -still / 1000) {
    stack_.resize(stack_.size() < 2 ? 0 : stack_.size() - 2);
    virgin_sign_ = x != 0 ? sign(x) : direction_;
    ++events_.closures;
  }
}

void OdeintMotion::break_away(int sign_of_motion) {
  held_torque_ = spring_torque(state_);
  if (std::abs(held_torque_) < 1e-14L * contact_.breakaway) held_torque_ = 0;  // of no sign but by rounding
  sliding_ = true;
  frozen_ = false;
  direction_ = sign_of_motion;
  ++events_.breakaways;
  if (sign(held_torque_) == -sign_of_motion) ++events_.breakaways_against_spring;
}

void OdeintMotion::stick() {
  origin_ = theta();
  contact_ = contact_at(origin_);
  frequency_ = std::sqrt((contact_.k1 + contact_.k2) / plant_.inertia);
  const int side = sign(held_torque_);
  offset_ = side * inverse_branch(2 * std::abs(held_torque_)) / 2;
  state_ = {0, 0, 0, 0};
  stack_.clear();
  sliding_ = resting_ = frozen_ = false;
  creeping_ = true;
  virgin_sign_ = side != 0 ? side : direction_;
  ++events_.resticks;
}

}  // namespace zerocount::testing
