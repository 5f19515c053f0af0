#pragma once

#include "core/loop/formulas.hpp"

/// The formulas of the controller's blocks, for double and for the vectors of the batch engine.
namespace zerocount::loop {

/// When and how the integral changes.
template <class Number>
struct IntegralConstants {
  Number enter, leave;     ///< deadband, counts
  Number zone;             ///< counts
  Number retention;        ///< exp(−T/τ), the factor of I per sample
  Number lowest, highest;  ///< of I, N m
};

template <class Number>
struct IntegralState {
  Number integral;  ///< I, N m
  Number inside;    ///< the deadband: 0 or 1
};

/// Whether the error is inside the deadband: from |e| ≤ enter on until |e| > leave. @returns a mask.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE auto inside_deadband(const IntegralConstants<Number>& c, const Number& inside,
                                             const Number& error) {
  return abs(error) <= select(inside != Number(0.0), c.leave, c.enter);
}

/// I ← clamp(retention·I + increment) where |e| is outside the deadband and within the zone.
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

/// d_k = a·d_{k−1} + (1 − a)·(count_k − count_{k−1}), counts.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number filtered_difference(const Number& a, const Number& last,
                                                   const Number& change) {
  return a * last + (Number(1.0) - a) * change;
}

/// (b₀ + b₁·z⁻¹ + b₂·z⁻²)/(1 + a₁·z⁻¹ + a₂·z⁻²).
template <class Number>
struct BiquadConstants {
  Number b0, b1, b2, a1, a2;
};

/// Direct form II transposed.
template <class Number>
struct BiquadState {
  Number s1, s2;
};

/// y = b₀·x + s₁,  s₁ ← b₁·x − a₁·y + s₂,  s₂ ← b₂·x − a₂·y. @returns y.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number biquad_step(const BiquadConstants<Number>& c, BiquadState<Number>& state,
                                           const Number& x) {
  const Number y = c.b0 * x + state.s1;
  state.s1 = c.b1 * x - c.a1 * y + state.s2;
  state.s2 = c.b2 * x - c.a2 * y;
  return y;
}

/// d̂ = A·(1 − z⁻¹)²/(1 + a₁·z⁻¹ + a₂·z⁻²)·count − q·(1 + z⁻¹)²/(1 + a₁·z⁻¹ + a₂·z⁻²)·torque.
template <class Number>
struct ObserverConstants {
  Number acceleration;  ///< A, N m/count
  Number q;
  Number a1, a2;
};

/// @param travel count_k − count_0, counts. @param torque decided one sample before, N m. @returns d̂, N m.
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

/// Gains of the cascade, per count.
template <class Number>
struct CascadeConstants {
  Number kv;        ///< kv·Δx: velocity command per error, rad/s per count
  Number velocity;  ///< Δx/T: velocity per difference of successive counts, rad/s per count
  Number kp;        ///< N m s/rad
  Number ki;        ///< ki·T/2, N m s/rad
};

/// v* − v = kv·Δx·e_k − (Δx/T)·d_k, rad/s.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number velocity_error(const CascadeConstants<Number>& c, const Number& error,
                                              const Number& d) {
  return c.kv * error - c.velocity * d;
}

/// kp·w + I, N m. @param w v* − v, rad/s.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number cascade_torque(const Number& integral, const Number& kp, const Number& w) {
  return kp * w + integral;
}

}  // namespace zerocount::loop
