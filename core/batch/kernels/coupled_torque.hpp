#pragma once

#include "core/batch/kernels/applied_torque.hpp"

/// The torque on the rotor as a power series, where it varies or a second mass is coupled to the rotor.
namespace zerocount::batch {

/// Taylor series over one step of the torque on the rotor, where it varies or where a second mass is coupled
/// to the rotor. The second mass acts on the rotor by the torque Ts of the coupling, with twist δ and
/// velocity ωL. Their series give Ts order by order (motion::expand):
///
///   dδ/dt = ω − ωL,   JL·dωL/dt = Ts,   Ts = kL·δ + dL·(ω − ωL).
template <class P>
struct ForcedTorque {
  static constexpr bool forced = true;
  Forcing forcing;
  VaryingTorque<P> alone;    ///< Torque on the rotor without the coupling torque of the second mass; used
                             /// < only if it varies.
  P twist[batch_order + 1];  ///< Coefficients of the coupling's twist δ, rad
  P omega[batch_order + 1];  ///< Coefficients of ωL·h, with ωL the velocity of the second mass and h the
                             /// < step, rad
  P change;       ///< Σ k·|coefficient k|, a bound of the torque's rate, in the unit of the torque per step
  P unit;         ///< Factor that converts a torque (N m) to the unit of the torque's coefficients, 1/(N m)
  P travel_unit;  ///< One unit of the coefficients of the rotor's ω·h, rad
  P stiffness;    ///< Stiffness kL of the coupling, N m/rad
  P damping;      ///< Damping of the coupling divided by the step: dL/h, N m/rad
  P acceleration;  ///< h²/JL, which converts the coupling torque to an acceleration over the step, rad/(N m)

  /// Computes coefficient k of the torque's series. Must be called in ascending order of k. Coefficient 0
  /// leaves out a constant torque.
  /// @param velocity_k coefficient k of the rotor's ω·h.
  ZEROCOUNT_ALWAYS_INLINE P coefficient(int k, const P& velocity_k) {
    P torque(0.0);
    if (forcing.varies) torque = alone.coefficient(k, velocity_k);
    if (forcing.loaded) {
      const P per_order(numerics::reciprocal.of[k + 1]);
      const P relative = travel_unit * velocity_k - omega[k];
      const P coupling = stiffness * twist[k] + damping * relative;
      twist[k + 1] = relative * per_order;
      omega[k + 1] = acceleration * coupling * per_order;
      torque = forcing.varies ? torque - unit * coupling : -(unit * coupling);
    }
    change = change + P(static_cast<double>(k)) * abs(torque);
    return torque;
  }
};

/// The constant torque on the rotor of lanes without a varying torque and without a second mass,
/// MotionLanes::torque.
struct ConstantTorque {
  static constexpr bool forced = false;

  template <class P>
  ZEROCOUNT_ALWAYS_INLINE P coefficient(int, const P&) const {
    return P(0.0);
  }
};

/// Overloads that map the type of a forcing to the type of the torque's series; declared only for their
/// return types.
template <class P>
ForcedTorque<P> torque_with(Forcing);
template <class P>
ConstantTorque torque_with(Unforced);

template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void load_torque(const BatchState&, const At&, Unforced, const P&, const P&, const P&,
                                         ConstantTorque&) {}

/// Loads the series of the torque on the rotor for a step of length h (s).
/// @param unit factor that converts a torque (N m) to the unit of the series, 1/(N m).
/// @param travel_unit one unit of the coefficients of the rotor's ω·h, rad.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void load_torque(const BatchState& batch, const At& at, Forcing forcing, const P& h,
                                         const P& unit, const P& travel_unit, ForcedTorque<P>& torque) {
  torque.forcing = forcing;
  torque.change = P(0.0);
  if (forcing.varies) load_torque(batch, at, h, unit, travel_unit, torque.alone);
  if (!forcing.loaded) return;
  const LoadLanes& l = batch.load;
  torque.twist[0] = at.load(l.twist);
  torque.omega[0] = at.load(l.omega) * h;
  torque.unit = unit;
  torque.travel_unit = travel_unit;
  torque.stiffness = at.load(l.stiffness);
  torque.damping = at.load(l.damping) / h;
  torque.acceleration = h * h * at.load(l.per_inertia);
}

/// Torque on the rotor at this instant, including the coupling torque of a second mass, N m.
/// @param omega velocity ω of the rotor, rad/s.
template <class P, class At, class F>
ZEROCOUNT_ALWAYS_INLINE P torque_on_rotor(const BatchState& batch, const At& at, F forcing, const P& omega) {
  const P torque = at.load(batch.motion.torque);
  if (!forcing.loaded) return torque;
  const LoadLanes& l = batch.load;
  return torque - (at.load(l.stiffness) * at.load(l.twist) + at.load(l.damping) * (omega - at.load(l.omega)));
}

/// Direction in which the rotor moves from this instant on: the sign of ω or, at ω = 0, of its first non-zero
/// derivative (motion::heading_under).
/// @param omega ω, rad/s.
/// @param excess torque on the rotor minus friction, N m.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P heading_under(const BatchState& batch, const At& at, Forcing forcing,
                                        const P& omega, const P& excess) {
  const P direction = sign(select(omega == P(0.0), excess, omega));
  if (!forcing.varies) return direction;
  return select(direction == P(0.0), sign(torque_rate(batch, at, omega)), direction);
}

/// Mask of the lanes whose second mass is quiet: the coupling torque of any oscillation stays below `torque`
/// (see motion::is_quiet).
/// @param steady coupling torque without the oscillation, N m.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask load_is_quiet(const BatchState& batch, const At& at, const P& omega,
                                                       const P& torque, const P& steady) {
  const LoadLanes& l = batch.load;
  return abs(at.load(l.stiffness) * at.load(l.twist) - steady) +
             at.load(l.torque_by_velocity) * abs(omega - at.load(l.omega)) <
         torque;
}

/// Holds the rotors of these lanes at rest, and lets their second masses follow, up to each lane's next stop
/// (at which its torque may change).
template <class At, class P = typename At::Vector>
ZEROCOUNT_ALWAYS_INLINE void halt_to_next_stop(BatchState& batch, const At& at, Forcing forcing) {
  const P zero(0.0);
  at.store(batch.motion.omega, zero);
  at.store(batch.motion.gradual_slide, zero);
  if (forcing.loaded) {
    at.store(batch.load.twist, zero);
    at.store(batch.load.omega, zero);
    at.store(batch.loop.read_twist, zero);
  }
  at.store(batch.time.time_to_stop, zero);
}

/// Absolute value of the last two terms of the second mass's series at the end of a step, rad; 0 without a
/// second mass. Estimates the truncation error.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P last_terms_of_load(const ForcedTorque<P>& t) {
  constexpr int last = batch_order;
  if (!t.forcing.loaded) return P(0.0);
  return (abs(t.twist[last - 1]) + abs(t.twist[last])) + (abs(t.omega[last - 1]) + abs(t.omega[last]));
}

/// Stores the state of the second mass, if any, at the fraction x of a step of length h (s), in the lanes of
/// `done`.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void store_load(BatchState& batch, const At& at, const ForcedTorque<P>& t, const P& x,
                                        const P& h, const typename P::Mask& done) {
  if (!t.forcing.loaded) return;
  LoadLanes& l = batch.load;
  const P twist = select(done, value_of(t.twist, batch_order, x), t.twist[0]);
  at.store(l.twist, twist);
  at.store(l.omega, select(done, value_of(t.omega, batch_order, x) / h, at.load(l.omega)));
  at.store(batch.loop.read_twist, twist * at.load(l.reads));
}

}  // namespace zerocount::batch
