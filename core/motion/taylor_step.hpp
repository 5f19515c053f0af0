#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>

#include "core/motion/disturbance.hpp"
#include "core/motion/load.hpp"
#include "core/motion/torque_course.hpp"
#include "core/numerics/power_series.hpp"

namespace zerocount::motion {

/// Tolerances of the integrator that computes the plant's motion by Taylor steps.
struct MotionTolerance {
  /// Truncation error allowed per Taylor step, and the excess of hardening that starts creep, rad. A trial
  /// uses 1e-11 of a fine count.
  double elongation{4e-16};
  /// Amplitude below which an oscillation counts as rest, and the opening below which a loop of the spring
  /// counts as closed, rad. A trial uses 1e-8 of a fine count.
  double rest{4e-14};
};

/// The first event within an integration step: a kink of the motion, at which the step ends. `Event` is an
/// enumeration of the events of a friction law, with a value `none`.
template <class Event>
struct NextEvent {
  double time;  ///< Time of the event from the start of the step, s; without an event, the end of the step
  Event event{Event::none};

  /// Replaces the present event by the event `what` at the time `candidate` (s), unless `candidate` is empty
  /// or later.
  void offer(std::optional<double> candidate, Event what) {
    if (!candidate || *candidate > time) return;
    time = *candidate;
    event = what;
  }
};

/// A motion J·dω/dt = u − F that is analytic in time up to its next event. F may depend on a state of its
/// own, dz/dt = f(z, ω). The members:
///
///   Expansion                   Taylor coefficients of all that moves, among them
///                               position (rad, its error is bounded), omega (rad/s) and exponent (that of
///                               the motion's one exponential, dimensionless; 0 without one)
///   start()                     the coefficients 0 of the state
///   expand(series, k, u_k)      computes the coefficients k of functions of the state, and k + 1 of the
///                               state except ω; returns coefficient k of u − F, N m
///   complete(series)            optional: computes the coefficients series_order that events need
///   step_of_state(series, tolerance, duration)
///                               optional: step_within() for a state z whose errors are not errors of the
///                               position
///   first_event(series, step)   the first event within `step` (s), located in time
///   go_to(series, next)         advances the state to next.time, through next.event
template <class Motion>
concept SmoothMotion = requires(Motion motion, const Motion now, typename Motion::Expansion series,
                                std::size_t k, double value, const NextEvent<typename Motion::Event> next) {
  { series.position } -> std::same_as<numerics::Series&>;
  { series.omega } -> std::same_as<numerics::Series&>;
  { series.exponent } -> std::same_as<numerics::Series&>;
  { now.start() } -> std::same_as<typename Motion::Expansion>;
  { now.expand(series, k, value) } -> std::same_as<double>;
  { now.first_event(series, value) } -> std::same_as<NextEvent<typename Motion::Event>>;
  motion.go_to(series, next);
};

/// Computes the Taylor series of a motion from its present state.
/// @param inertia J, kg m².
/// @param torque torque on the rotor.
/// @param load_series receives the series of the load of `torque`; unused without a load.
template <SmoothMotion Motion>
typename Motion::Expansion motion_series(const Motion& motion, double inertia, const TorqueCourse& torque,
                                         LoadSeries& load_series) {
  const numerics::Series applied = torque_series(torque);
  const double per_inertia = 1.0 / inertia;
  typename Motion::Expansion series;
  const auto add_orders = [&](const auto& coupling) {
    series = motion.start();
    for (std::size_t k = 0; k < numerics::series_order; ++k) {
      const double acceleration = motion.expand(series, k, applied[k] - coupling(k)) * per_inertia;
      series.omega[k + 1] = acceleration * numerics::reciprocal[k + 1];
    }
  };
  const auto of_load = [&](std::size_t k) { return expand(load_series, *torque.load, series.omega, k); };
  const auto add_all = [&] {
    if (torque.disturbance != nullptr) {
      DisturbanceSeries disturbance(*torque.disturbance);
      add_orders([&](std::size_t k) {
        return (torque.load == nullptr ? 0.0 : of_load(k)) - disturbance.expand(series.omega, k);
      });
    } else if (torque.load != nullptr) {
      add_orders(of_load);
    } else {
      add_orders([](std::size_t) { return 0.0; });
    }
  };
  if (torque.load != nullptr) start_series(load_series, *torque.load, 0.0);
  add_all();
  if (torque.load != nullptr) {
    // On an edge of the gap the first derivative of the twist that is not 0 is the same on both sides.
    const double heading = heading_from_edge(load_series, torque.load->parameters);
    if (heading * torque.load->twist > 0.0) {
      start_series(load_series, *torque.load, heading);
      add_all();
    }
  }
  if constexpr (requires { motion.complete(series); }) motion.complete(series);
  return series;
}

/// The longest step t ≤ `longest` (s) over which both hold:
/// - the last two terms of the series of a position, and those of its velocity times t, stay below
///   `tolerance`·t/longest (rad), so that the truncation errors of a whole interval sum to at most
///   `tolerance`. Two terms, because one may vanish by chance;
/// - the exponent of the motion's one exponential grows by at most 6, or stays below −40. The terms zᵏ/k! of
///   exp(z) rise up to k = z: with more growth the last terms kept may be small before the largest.
/// The exp(−rt) of a varying torque needs no such bound: where rt exceeds the order of the series, its last
/// terms are the largest, so that they limit the step.
double step_within(const numerics::Series& position, const numerics::Series& velocity,
                   const numerics::Series& exponent, double tolerance, double longest);

/// Advances the motion, and the load of `torque`, along their Taylor series: to the end of the longest
/// accurate step, to the motion's first event or to an edge of the coupling's gap, whichever comes first.
/// @param tolerance truncation error of the position allowed, rad.
/// @param duration longest step, s.
/// @returns the time used and the event.
template <SmoothMotion Motion>
NextEvent<typename Motion::Event> step_along(const typename Motion::Expansion& series,
                                             const LoadSeries& load_series, const TorqueCourse& torque,
                                             Motion& motion, double tolerance, double duration) {
  double step = step_within(series.position, series.omega, series.exponent, tolerance, duration);
  if constexpr (requires { motion.step_of_state(series, tolerance, duration); }) {
    step = std::min(step, motion.step_of_state(series, tolerance, duration));
  }
  std::optional<EdgeOfGap> edge;
  std::optional<double> at_friction;
  if (torque.load != nullptr) {
    step = std::min(step,
                    step_within(load_series.twist, load_series.omega, series.exponent, tolerance, duration));
    LoadFriction* const friction = torque.load->friction;
    if (friction != nullptr) step = std::min(step, friction->step_within(tolerance, duration));
    edge = next_edge(load_series, torque.load->parameters, step);
    if (edge) step = edge->time;
    if (friction != nullptr) at_friction = friction->next_event(load_series.omega, step);
    if (at_friction) step = *at_friction;
    if (at_friction == 0.0) {
      friction->go_to(0.0, true, *torque.load);
      return {0.0};
    }
  }
  const NextEvent<typename Motion::Event> next = motion.first_event(series, step);
  motion.go_to(series, next);
  if (torque.load == nullptr) return next;
  go_to(*torque.load, load_series, next.time);
  // Exactly on the edge, so that rounding cannot meet it again.
  if (edge && next.time == edge->time) torque.load->twist = edge->twist;
  if (torque.load->friction != nullptr)
    torque.load->friction->go_to(next.time, at_friction == next.time, *torque.load);
  return next;
}

/// Computes the Taylor series of the motion from its present state, and advances the motion along them by
/// step_along().
/// @param inertia J, kg m².
/// @param tolerance truncation error of the position allowed, rad.
/// @param duration longest step, s.
template <SmoothMotion Motion>
NextEvent<typename Motion::Event> taylor_step(Motion& motion, double inertia, const TorqueCourse& torque,
                                              double tolerance, double duration) {
  LoadSeries load_series;
  const typename Motion::Expansion series = motion_series(motion, inertia, torque, load_series);
  return step_along(series, load_series, torque, motion, tolerance, duration);
}

/// First time in (0, end] at which the power series `series` changes its sign; empty if it does not. A start
/// at exactly zero is not a change of sign.
std::optional<double> next_sign_change(std::span<const double> series, double end);

}  // namespace zerocount::motion
