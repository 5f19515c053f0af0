#include "core/friction/presliding/sticking.hpp"

#include <cmath>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::friction {
namespace {

/// A power series minus a constant.
numerics::Series less(numerics::Series series, double constant) {
  series[0] -= constant;
  return series;
}

/// A constant minus `factor` times a power series.
numerics::Series scaled_difference(double constant, double factor, numerics::Series series) {
  for (double& coefficient : series) coefficient *= -factor;
  series[0] += constant;
  return series;
}

}  // namespace

StickingSeries Sticking::start() const {
  const SpringBranch& branch = spring.branch();
  StickingSeries s;
  s.position[0] = spring.elongation();
  s.omega[0] = omega;
  s.extension[0] = creep.extension;
  s.hardening[0] = creep.hardening;
  s.exponent[0] = exponent_coefficient(spring.elongation() - branch.elongation);
  s.softness[0] = numerics::exp(s.exponent[0]);
  s.spring_torque[0] = spring.torque();
  s.torque_sign = s.spring_torque[0] < 0.0 ? -1.0 : 1.0;
  s.per_lambda = 1.0 / contact.lambda;
  s.magnitude[0] = std::abs(s.spring_torque[0]);
  if (creeping) s.power[0] = torque_power(contact, s.magnitude[0]);
  return s;
}

motion::NextEvent<Sticking::Event> Sticking::first_event(const StickingSeries& series, double step) const {
  motion::NextEvent<Event> next{step};
  // The reversal first: up to it the elongation, and with it σ, is monotonic, which the others rely on.
  next.offer(motion::next_sign_change(series.elongation_rate, next.time), Event::reversal);
  find_closure(series, next);
  find_creep_change(series, next);
  find_breakaway(series, next);
  return next;
}

/// Replaces `next` by the closure of the spring's minor loop if that comes earlier. The elongation is
/// monotonic up to `next.time`, where the next reversal would be.
void Sticking::find_closure(const StickingSeries& series, motion::NextEvent<Event>& next) const {
  const std::optional<double> end = spring.branch_end();
  if (!end) return;
  const numerics::Series distance = less(series.position, *end);
  if (spring.direction() * numerics::value_at(distance, next.time) < 0.0) return;
  next.offer(numerics::bracketed_root(distance, 0.0, next.time), Event::closure);
}

/// Replaces `next` by the start or end of creep if that comes earlier. The spring torque σ is monotonic up to
/// `next.time`, so it passes the onset at most once.
void Sticking::find_creep_change(const StickingSeries& series, motion::NextEvent<Event>& next) const {
  if (creeping) {
    next.offer(motion::next_sign_change(series.creep_rate, next.time), Event::creep_off);
    return;
  }
  const double at_end = numerics::value_at(series.spring_torque, next.time);
  if (std::abs(at_end) < creep_onset_torque) return;
  const numerics::Series beyond = less(series.spring_torque, std::copysign(creep_onset_torque, at_end));
  next.offer(numerics::bracketed_root(beyond, 0.0, next.time), Event::creep_on);
}

/// Replaces `next` by the breakaway if that comes earlier: the instant at which the hook's torque |σ + c·ω|
/// reaches the breakaway torque in the direction of motion.
void Sticking::find_breakaway(const StickingSeries& series, motion::NextEvent<Event>& next) const {
  numerics::Series hook_torque{};
  for (std::size_t k = 0; k <= numerics::series_order; ++k) {
    hook_torque[k] = series.spring_torque[k] + damping * series.omega[k];
  }
  if (std::abs(hook_torque[0]) + numerics::excursion_bound(hook_torque, next.time) < contact.breakaway)
    return;
  for (const double sign : {1.0, -1.0}) {
    if (sign * hook_torque[0] >= contact.breakaway) continue;
    const numerics::Series margin = scaled_difference(contact.breakaway, sign, hook_torque);
    const std::optional<double> reached = numerics::first_sign_change(margin, next.time);
    if (reached && sign * numerics::value_at(series.omega, *reached) > 0.0)
      next.offer(reached, Event::breakaway);
  }
  // Against the direction of motion the hook holds, even beyond the breakaway torque, until ω = 0.
  next.offer(motion::next_sign_change(series.omega, next.time), Event::velocity_zero);
}

void Sticking::go_to(const StickingSeries& series, const motion::NextEvent<Event>& next) {
  omega = numerics::value_at(series.omega, next.time);
  creep.extension = numerics::value_at(series.extension, next.time);
  creep.hardening = numerics::value_at(series.hardening, next.time);
  spring.move_on_branch(next.event == Event::closure ? *spring.branch_end()
                                                     : numerics::value_at(series.position, next.time));
}

}  // namespace zerocount::friction
