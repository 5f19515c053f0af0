#include "core/plant/events.hpp"

#include <array>
#include <cmath>
#include <span>

#include "core/numerics/first_root.hpp"

namespace zerocount {
namespace {

/// The series minus a constant: its root is where the quantity takes that value.
Series less(Series series, double constant) {
  series[0] -= constant;
  return series;
}

/// constant − factor·series.
Series scaled_difference(double constant, double factor, Series series) {
  for (double& coefficient : series) coefficient *= -factor;
  series[0] += constant;
  return series;
}

/// First time in (0, end] at which `series` changes sign, where a start at exactly zero does not count.
std::optional<double> next_sign_change(std::span<const double> series, double end) {
  while (!series.empty() && series.front() == 0.0) series = series.subspan(1);
  if (series.empty()) return std::nullopt;
  return first_sign_change(series, end);
}

/// The loop closure ahead. The elongation is monotonic up to `next.time`, where the next reversal would be.
void find_closure(const HystereticSpring& spring, const PreslidingSeries& series, NextEvent& next) {
  const std::optional<double> end = spring.branch_end();
  if (!end) return;
  const Series distance = less(series.elongation, *end);
  if (spring.direction() * value_at(distance, next.time) < 0.0) return;
  next.offer(bracketed_root(distance, 0.0, next.time), Event::closure);
}

/// The start or end of creep. σ is monotonic up to `next.time`, so it passes the onset at most once.
void find_creep_change(const PreslidingSeries& series, bool creeping, double onset_torque, NextEvent& next) {
  if (creeping) {
    next.offer(next_sign_change(series.creep_rate, next.time), Event::creep_off);
    return;
  }
  const double at_end = value_at(series.spring_torque, next.time);
  if (std::abs(at_end) < onset_torque) return;
  const Series beyond = less(series.spring_torque, std::copysign(onset_torque, at_end));
  next.offer(bracketed_root(beyond, 0.0, next.time), Event::creep_on);
}

/// The instant at which |σ + c·ω| reaches the breakaway torque in the direction of motion.
void find_breakaway(const PlantParameters& plant, const FrictionParameters& contact,
                    const PreslidingSeries& series, NextEvent& next) {
  Series hook_torque{};
  for (std::size_t k = 0; k <= series_order; ++k) {
    hook_torque[k] = series.spring_torque[k] + plant.presliding_damping * series.omega[k];
  }
  if (std::abs(hook_torque[0]) + excursion_bound(hook_torque, next.time) < contact.breakaway) return;
  for (const double sign : {1.0, -1.0}) {
    if (sign * hook_torque[0] >= contact.breakaway) continue;
    const Series margin = scaled_difference(contact.breakaway, sign, hook_torque);
    const std::optional<double> reached = first_sign_change(margin, next.time);
    if (reached && sign * value_at(series.omega, *reached) > 0.0) next.offer(reached, Event::breakaway);
  }
  // Where the level is passed against the motion, the hook holds until the motion turns.
  next.offer(next_sign_change(series.omega, next.time), Event::velocity_zero);
}

}  // namespace

void NextEvent::offer(std::optional<double> candidate, Event what) {
  if (!candidate || *candidate > time) return;
  time = *candidate;
  event = what;
}

NextEvent next_presliding_event(const PreslidingSeries& series, const StickingContact& contact, double step) {
  NextEvent next{step};
  // The reversal first: up to it the elongation, and with it σ, is monotonic, which the others rely on.
  next.offer(next_sign_change(series.elongation_rate, next.time), Event::reversal);
  find_closure(contact.spring, series, next);
  find_creep_change(series, contact.creeping, contact.creep_onset_torque, next);
  find_breakaway(contact.plant, contact.friction, series, next);
  return next;
}

NextEvent next_sliding_event(const SlidingSeries& series, double step) {
  NextEvent next{step};
  next.offer(next_sign_change(series.omega, next.time), Event::velocity_zero);
  return next;
}

}  // namespace zerocount
