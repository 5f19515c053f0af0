#pragma once

#include "core/loop/formulas.hpp"

/// The formulas of the controller's blocks, for double and for the vectors of the batch engine.
namespace zerocount::loop {

/// Constants of the controller's integral: deadband, zone, leak and range.
template <class Number>
struct IntegralConstants {
  Number enter, leave;     ///< Largest |e| that starts the integral's deadband, and largest |e| that keeps
                           /// < it, counts
  Number zone;             ///< Largest absolute error |e| at which the integral changes, counts
  Number retention;        ///< Factor exp(−T/τ) by which the leak reduces the integral per sample
  Number lowest, highest;  ///< Range to which the integral is clamped, N m
};

template <class Number>
struct IntegralState {
  Number integral;  ///< Integral I of the control law, N m
  Number inside;    ///< 1 while the error is inside the integral's deadband, otherwise 0
};

/// Mask: whether the error is inside the integral's deadband, which begins at |e| ≤ enter and ends at |e| >
/// leave.
/// @param inside 1 if it was inside at the last sample.
/// @param error e, counts.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE auto inside_deadband(const IntegralConstants<Number>& c, const Number& inside,
                                             const Number& error) {
  return abs(error) <= select(inside != Number(0.0), c.leave, c.enter);
}

/// Updates the integral: I ← clamp(retention·I + increment) where |e| is outside the deadband and within the
/// zone; otherwise I stays.
/// @param error e, counts.
/// @param increment N m.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE void integrate(const IntegralConstants<Number>& c, IntegralState<Number>& state,
                                       const Number& error, const Number& increment) {
  const auto inside = inside_deadband(c, state.inside, error);
  const auto stays = inside | (abs(error) > c.zone);
  const Number changed = clamped(c.retention * state.integral + increment, c.lowest, c.highest);
  state.integral = select(stays, state.integral, changed);
  state.inside = select(inside, Number(1.0), Number(0.0));
}

/// Constants of the dead zone that the controller applies to the error.
template <class Number>
struct ErrorDeadbandConstants {
  Number band;        ///< Half width of the dead zone, counts; negative: no dead zone
  Number subtracted;  ///< Counts subtracted from |e| beyond the band: 0 or the band
};

/// Error e′ after the dead zone, which the control law uses in place of `error`, counts.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number acting_error(const ErrorDeadbandConstants<Number>& c, const Number& error) {
  return select(abs(error) <= c.band, Number(0.0), error - c.subtracted * sign(error));
}

/// Number of successive samples, including this one, with |e| ≤ band. A new target restarts the count.
/// @param run result of this function at the last sample.
/// @param new_target 1 if the target is new at this sample, otherwise 0.
/// @param error e, counts.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number samples_within(const Number& band, const Number& run, const Number& new_target,
                                              const Number& error) {
  const Number before = select(new_target != Number(0.0), Number(0.0), run);
  return select(abs(error) <= band, before + Number(1.0), Number(0.0));
}

/// Constants of the controller's standstill function: when it begins, and the gains that act then.
template <class Number>
struct StandstillConstants {
  Number band;        ///< Largest |e| at standstill, counts
  Number dwell;       ///< Number of successive samples with |e| ≤ band after which the standstill gains act
  Number kp, ki, kd;  ///< Gains of the PID law at standstill, N m/count
};

/// Updates the number of successive samples at standstill, `run` (samples_within()), by this sample.
/// @returns a mask: true while the standstill gains act.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE auto stands_still(const StandstillConstants<Number>& c, Number& run,
                                          const Number& new_target, const Number& error) {
  run = samples_within(c.band, run, new_target, error);
  return (run >= c.dwell) & (new_target == Number(0.0));
}

/// Constants of the torque hold at standstill: when it begins and ends.
template <class Number>
struct HoldConstants {
  Number enter, leave;  ///< Largest |e| that starts the torque hold, and largest |e| that keeps it, counts
  Number dwell;         ///< Number of successive samples with |e| ≤ enter after which the hold begins
};

template <class Number>
struct HoldState {
  Number run;      ///< Number of successive samples with |e| ≤ enter (samples_within)
  Number holding;  ///< 1 while the torque is held, else 0
  Number torque;   ///< Wanted torque at the last sample, which is held, N m
};

/// Updates the state of the torque hold by this sample.
/// @param fresh 1 at a new target and at the first sample, otherwise 0.
/// @param error e, counts.
/// @returns a mask: true while the torque is held.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE auto holds_torque(const HoldConstants<Number>& c, HoldState<Number>& state,
                                          const Number& fresh, const Number& error) {
  state.run = samples_within(c.enter, state.run, fresh, error);
  const auto goes_on = (state.holding != Number(0.0)) & (abs(error) <= c.leave);
  const auto holds = ((state.run >= c.dwell) | goes_on) & (fresh == Number(0.0));
  state.holding = select(holds, Number(1.0), Number(0.0));
  return holds;
}

/// Square-wave dither torque at sample k: +amplitude where ⌊2·frequency·k/sample_rate⌋ is even, otherwise
/// −amplitude, N m.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number dither_torque(const Number& amplitude, const Number& frequency,
                                             const Number& sample_rate, const Number& k) {
  const Number half_periods = floor(Number(2.0) * frequency * k / sample_rate);
  const Number half = Number(0.5) * half_periods;
  return select(floor(half) == half, amplitude, -amplitude);
}

/// Low-pass filtered difference of successive counts, d_k = a·d_{k−1} + (1 − a)·(count_k − count_{k−1}),
/// counts.
/// @param a pole of the filter.
/// @param last d_{k−1}.
/// @param change count_k − count_{k−1}.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number filtered_difference(const Number& a, const Number& last,
                                                   const Number& change) {
  return a * last + (Number(1.0) - a) * change;
}

/// Coefficients of a second-order digital filter (biquad), (b₀ + b₁·z⁻¹ + b₂·z⁻²)/(1 + a₁·z⁻¹ + a₂·z⁻²).
template <class Number>
struct BiquadConstants {
  Number b0, b1, b2, a1, a2;
};

/// State s₁, s₂ of a second-order digital filter (biquad) in direct form II transposed.
template <class Number>
struct BiquadState {
  Number s1, s2;
};

/// Filters one sample x: y = b₀·x + s₁,  s₁ ← b₁·x − a₁·y + s₂,  s₂ ← b₂·x − a₂·y.
/// @returns the output y.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number biquad_step(const BiquadConstants<Number>& c, BiquadState<Number>& state,
                                           const Number& x) {
  const Number y = c.b0 * x + state.s1;
  state.s1 = c.b1 * x - c.a1 * y + state.s2;
  state.s2 = c.b2 * x - c.a2 * y;
  return y;
}

/// Constants of the disturbance observer, whose estimate is, with N = 1 + a₁·z⁻¹ + a₂·z⁻², d̂ = A·(1 −
/// z⁻¹)²/N·count − q·(1 + z⁻¹)²/N·torque.
template <class Number>
struct ObserverConstants {
  Number acceleration;  ///< Factor A from the second difference of counts to the accelerating torque, N
                        /// < m/count
  Number q;
  Number a1, a2;
};

/// Advances the disturbance observer by one sample.
/// @param travel count_k − count_0, counts.
/// @param torque torque decided one sample before, N m.
/// @returns the estimate d̂ of the disturbance torque, N m.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number observer_step(const ObserverConstants<Number>& c, BiquadState<Number>& state,
                                             const Number& travel, const Number& torque) {
  const Number inertia = c.acceleration * travel;
  const Number filtered = c.q * torque;
  const Number y = inertia - filtered + state.s1;
  state.s1 = Number(-2.0) * (inertia + filtered) - c.a1 * y + state.s2;
  state.s2 = inertia - filtered - c.a2 * y;
  return y;
}

/// Gains of the cascade (position loop around a velocity loop), converted to units of counts and samples.
template <class Number>
struct CascadeConstants {
  Number kv;        ///< Gain kv·Δx of the position loop: velocity command per error, rad/s per count
  Number velocity;  ///< Δx_v/T: measured velocity per difference of successive counts, rad/s per count
  Number kp;        ///< Proportional gain of the velocity loop, N m s/rad
  Number ki;        ///< Integral gain of the velocity loop by the trapezoidal rule, ki·T/2, N m s/rad
};

/// Velocity error of the cascade, v* − v = v* − (Δx_v/T)·d_k, rad/s.
/// @param command velocity command v*, rad/s: kv·Δx·e_k after VelocityCommand.
/// @param d filtered difference of counts, counts.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number velocity_error(const CascadeConstants<Number>& c, const Number& command,
                                              const Number& d) {
  return command - c.velocity * d;
}

/// Velocity command v* (rad/s), rounded half to even to a multiple of the resolution (rad/s).
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number rounded_command(const Number& command, const Number& resolution) {
  return resolution * rint(command / resolution);
}

/// Torque of the cascade's velocity loop, kp·w + I, N m.
/// @param w velocity error v* − v, rad/s.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number cascade_torque(const Number& integral, const Number& kp, const Number& w) {
  return kp * w + integral;
}

}  // namespace zerocount::loop
