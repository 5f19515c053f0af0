#pragma once

#include "core/numerics/number.hpp"

/// The formulas of the sampled loop, for double and for the vectors of the batch engine.
namespace zerocount::loop {

/// The ideal encoder: floor(θ/Δx + phase), counts.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number ideal_count(const Number& theta, const Number& resolution,
                                           const Number& phase) {
  return floor(theta / resolution + phase);
}

/// Constants of the noise of an encoder (ImperfectEncoder).
template <class Number>
struct NoiseConstants {
  Number deviation;  ///< Standard deviation sd, counts
  Number retention;  ///< Factor a by which a noise value enters the next one
  Number renewal;    ///< Factor √(1 − a²) of the random number
};

/// Noise w_k = a·w_{k−1} + √(1 − a²)·z_k, w_0 = z_0. @param first whether k = 0. @param drawn z_k.
template <class Number, class Mask>
ZEROCOUNT_ALWAYS_INLINE Number next_noise(const NoiseConstants<Number>& c, const Number& last,
                                          const Mask& first, const Number& drawn) {
  return select(first, drawn, c.retention * last + c.renewal * drawn);
}

/// Whether two ideal encoders show these counts at one and the same rotor angle (counts_agree).
/// @param from begin of the fine count, (c − phase)·q + phase, in coarse counts. @param ratio q.
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

/// Torque of the PID law, I + kp·e − kd·d, N m. @param d the difference of successive counts, filtered or
/// not.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number pid_torque(const Number& integral, const Number& kp, const Number& error,
                                          const Number& kd, const Number& d) {
  return integral + kp * error - kd * d;
}

/// State of the PID law.
template <class Number>
struct PidState {
  Number integral;    ///< I, N m
  Number last_error;  ///< e_{k−1}, counts
  Number last_count;  ///< counts
};

/// Gains of the PID law, and the bounds of its integral.
template <class Number>
struct PidConstants {
  Number kp, ki, kd;       ///< N m/count
  Number lowest, highest;  ///< Range of I, N m
};

/// I ← clamp(I + ki·(e_k + e_{k−1})),   u = I + kp·e_k − kd·(count_k − count_{k−1}).
/// @returns u, N m.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number pid_step(const PidConstants<Number>& c, PidState<Number>& state,
                                        const Number& error, const Number& count) {
  const Number change = count - state.last_count;
  state.integral = clamped(state.integral + c.ki * (error + state.last_error), c.lowest, c.highest);
  state.last_error = error;
  state.last_count = count;
  return pid_torque(state.integral, c.kp, error, c.kd, change);
}

/// The wanted code of the converter: round-half-even(torque/Δu), a whole number.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number wanted_code(const Number& torque, const Number& resolution) {
  return rint(torque / resolution);
}

/// The wanted code, limited to the converter's range.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number clipped_code(const Number& wanted, const Number& lowest,
                                            const Number& highest) {
  return clamped(wanted, lowest, highest);
}

/// The rounding error that a sigma-delta converter adds to the next torque, N m.
/// @param torque wanted torque, including the rounding error of the sample before, N m. @param converted
/// code·Δu, N m.
template <class Number, class Mask>
ZEROCOUNT_ALWAYS_INLINE Number rounding_remainder(const Number& torque, const Number& converted,
                                                  const Mask& clipped) {
  return select(clipped, Number(0.0), torque - converted);
}

}  // namespace zerocount::loop
