#pragma once

#include "core/numerics/number.hpp"

/// Formulas of the sampled control loop, as templates for double and for the vectors of the batch engine.
namespace zerocount::loop {

/// Count of the ideal encoder at the angle θ: floor(θ/Δx + phase).
/// @param resolution Δx, rad per count.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number ideal_count(const Number& theta, const Number& resolution,
                                           const Number& phase) {
  return floor(theta / resolution + phase);
}

/// Constants of the noise of an encoder: noise sd·w_k with w_k = a·w_{k−1} + √(1 − a²)·z_k, z_k standard
/// normal.
template <class Number>
struct NoiseConstants {
  Number deviation;  ///< Standard deviation sd of the noise, counts
  Number retention;  ///< Factor a by which the noise value w_{k−1} enters the next one
  Number renewal;    ///< Factor √(1 − a²) of the random number z_k in the next noise value
};

/// Next value of an encoder's noise in standard deviations, w_k = a·w_{k−1} + √(1 − a²)·z_k, w_0 = z_0.
/// @param last w_{k−1}.
/// @param first whether k = 0.
/// @param drawn standard normal number z_k.
template <class Number, class Mask>
ZEROCOUNT_ALWAYS_INLINE Number next_noise(const NoiseConstants<Number>& c, const Number& last,
                                          const Mask& first, const Number& drawn) {
  return select(first, drawn, c.retention * last + c.renewal * drawn);
}

/// Whether two ideal encoders show these counts at one and the same rotor angle (see counts_agree()).
/// @param from beginning of the fine count, (c − phase)·q + phase, in coarse counts.
/// @param ratio q, length of a fine count in coarse counts.
/// @param coarse count of the coarse encoder.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE auto counts_may_coincide(const Number& from, const Number& ratio,
                                                 const Number& coarse) {
  const Number rounding = Number(0x1p-48) * (Number(1.0) + abs(coarse));
  return (coarse + rounding < from + ratio) & (from + rounding < coarse + Number(1.0));
}

template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number clamped(const Number& value, const Number& lowest, const Number& highest) {
  return min(max(value, lowest), highest);
}

/// Torque of the PID law, I + kp·e − kd·d, N m.
/// @param integral I.
/// @param error e, counts.
/// @param d difference of successive counts, filtered or not.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number pid_torque(const Number& integral, const Number& kp, const Number& error,
                                          const Number& kd, const Number& d) {
  return integral + kp * error - kd * d;
}

/// State of the PID law between two samples.
template <class Number>
struct PidState {
  Number integral;    ///< Integral I, N m
  Number last_error;  ///< Error e_{k−1} at the last sample, counts
  Number last_count;  ///< Count at the last sample
};

/// Gains of the PID law, and the range of its integral.
template <class Number>
struct PidConstants {
  Number kp, ki, kd;       ///< Gains on the error, its trapezoidal integral, and the difference of counts, N
                           /// < m/count
  Number lowest, highest;  ///< Range to which the integral I is clamped, N m
};

/// One sample of the PID law: I ← clamp(I + ki·(e_k + e_{k−1})),   u = I + kp·e_k − kd·(count_k −
/// count_{k−1}).
/// @returns the torque u, N m.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number pid_step(const PidConstants<Number>& c, PidState<Number>& state,
                                        const Number& error, const Number& count) {
  const Number change = count - state.last_count;
  state.integral = clamped(state.integral + c.ki * (error + state.last_error), c.lowest, c.highest);
  state.last_error = error;
  state.last_count = count;
  return pid_torque(state.integral, c.kp, error, c.kd, change);
}

/// Code of the digital-to-analogue converter for a torque, before it is limited to the range:
/// round-half-even(torque/Δu), a whole number.
/// @param resolution Δu, N m.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number wanted_code(const Number& torque, const Number& resolution) {
  return rint(torque / resolution);
}

/// The code limited to the range of the digital-to-analogue converter, from `lowest` to `highest`.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number clipped_code(const Number& wanted, const Number& lowest,
                                            const Number& highest) {
  return clamped(wanted, lowest, highest);
}

/// The rounding error that a sigma-delta converter adds to the next torque, N m; 0 if the code was clipped.
/// @param torque wanted torque, including the rounding error of the sample before, N m.
/// @param converted torque of the rounded code, code·Δu, N m.
template <class Number, class Mask>
ZEROCOUNT_ALWAYS_INLINE Number rounding_remainder(const Number& torque, const Number& converted,
                                                  const Mask& clipped) {
  return select(clipped, Number(0.0), torque - converted);
}

}  // namespace zerocount::loop
