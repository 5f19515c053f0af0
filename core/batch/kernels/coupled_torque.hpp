#pragma once

#include "core/batch/kernels/applied_torque.hpp"

/// The torque on a rotor with a second mass.
namespace zerocount::batch {

/// The torque of the motor and of a disturbance, less that of the coupling to the load, which the series of
/// the load gives order by order (motion::expand):
///
///   dδ/dt = ω − ωL,   JL·dωL/dt = Ts,   Ts = kL·δ + dL·(ω − ωL).
///
/// @tparam Alone the torque without the load: ConstantTorque or VaryingTorque.
template <class P, class Alone>
struct CoupledTorque {
  static constexpr bool varies = true;
  Alone alone;
  P twist[batch_order + 1];  ///< δ, rad
  P omega[batch_order + 1];  ///< ωL·h, rad
  P change;                  ///< as VaryingTorque::change
  P unit;                    ///< of the torque's coefficients, 1/(N m)
  P travel_unit;             ///< of the rotor's ω·h, rad
  P stiffness;               ///< kL, N m/rad
  P damping;                 ///< dL/h, N m/rad
  P acceleration;            ///< h²/JL, rad/(N m)

  /// Coefficient k of the torque, in ascending order; that of order 0 without the torque of `alone`, if that
  /// is constant. @param velocity_k that of the rotor's ω·h
  ZEROCOUNT_ALWAYS_INLINE P coefficient(int k, const P& velocity_k) {
    const P per_order(numerics::reciprocal.of[k + 1]);
    const P relative = travel_unit * velocity_k - omega[k];
    const P coupling = stiffness * twist[k] + damping * relative;
    twist[k + 1] = relative * per_order;
    omega[k + 1] = acceleration * coupling * per_order;
    P torque = -(unit * coupling);
    if constexpr (Alone::varies) torque = torque + alone.coefficient(k, velocity_k);
    change = change + P(static_cast<double>(k)) * abs(torque);
    return torque;
  }
};

/// Whether a torque may have ripples.
template <class Torque>
inline constexpr bool has_ripples = false;
template <class P>
inline constexpr bool has_ripples<VaryingTorque<P>> = true;
template <class P>
inline constexpr bool has_ripples<CoupledTorque<P, VaryingTorque<P>>> = true;

/// The torque on the rotors of the lanes. @tparam Varies without a load it varies. @tparam Loaded there is a
/// load.
template <class P, bool Varies, bool Loaded>
struct TorqueOf {
  using Type = ConstantTorque;
};
template <class P>
struct TorqueOf<P, true, false> {
  using Type = VaryingTorque<P>;
};
template <class P, bool Varies>
struct TorqueOf<P, Varies, true> {
  using Type = CoupledTorque<P, typename TorqueOf<P, Varies, false>::Type>;
};

template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void load_torque(const BatchState&, const At&, const P&, const P&, const P&,
                                         ConstantTorque&) {}

template <class P, class At, class Alone>
ZEROCOUNT_ALWAYS_INLINE void load_torque(const BatchState& batch, const At& at, const P& h, const P& unit,
                                         const P& travel_unit, CoupledTorque<P, Alone>& torque) {
  const LoadLanes& l = batch.load;
  load_torque(batch, at, h, unit, travel_unit, torque.alone);
  torque.twist[0] = at.load(l.twist);
  torque.omega[0] = at.load(l.omega) * h;
  torque.change = P(0.0);
  torque.unit = unit;
  torque.travel_unit = travel_unit;
  torque.stiffness = at.load(l.stiffness);
  torque.damping = at.load(l.damping) / h;
  torque.acceleration = h * h * at.load(l.per_inertia);
}

/// The torque on the rotor at this instant, N m. @param omega ω of the rotor, rad/s.
template <bool Loaded, class P, class At>
ZEROCOUNT_ALWAYS_INLINE P torque_on_rotor(const BatchState& batch, const At& at,
                                          [[maybe_unused]] const P& omega) {
  const P torque = at.load(batch.motion.torque);
  if constexpr (!Loaded) return torque;
  const LoadLanes& l = batch.load;
  return torque - (at.load(l.stiffness) * at.load(l.twist) + at.load(l.damping) * (omega - at.load(l.omega)));
}

/// motion::is_quiet of the loads of the lanes.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask load_is_quiet(const BatchState& batch, const At& at, const P& omega,
                                                       const P& torque, const P& steady) {
  const LoadLanes& l = batch.load;
  return abs(at.load(l.stiffness) * at.load(l.twist) - steady) +
             at.load(l.torque_by_velocity) * abs(omega - at.load(l.omega)) <
         torque;
}

/// Lets lanes rest, with their loads, up to the next stop.
template <bool Loaded, class At, class P = typename At::Vector>
ZEROCOUNT_ALWAYS_INLINE void halt_to_next_stop(BatchState& batch, const At& at) {
  const P zero(0.0);
  at.store(batch.motion.omega, zero);
  at.store(batch.motion.gradual_slide, zero);
  if constexpr (Loaded) {
    at.store(batch.load.twist, zero);
    at.store(batch.load.omega, zero);
    at.store(batch.loop.read_twist, zero);
  }
  at.store(batch.time.time_to_stop, zero);
}

/// The last two terms of the series of the load at the end of a step, rad.
template <class P, class Alone>
ZEROCOUNT_ALWAYS_INLINE P last_terms_of_load(const CoupledTorque<P, Alone>& t) {
  constexpr int last = batch_order;
  return (abs(t.twist[last - 1]) + abs(t.twist[last])) + (abs(t.omega[last - 1]) + abs(t.omega[last]));
}

/// Stores the load at the fraction x of a step of h (s), in the lanes of `done`.
template <class P, class At, class Alone>
ZEROCOUNT_ALWAYS_INLINE void store_load(BatchState& batch, const At& at, const CoupledTorque<P, Alone>& t,
                                        const P& x, const P& h, const typename P::Mask& done) {
  LoadLanes& l = batch.load;
  const P twist = select(done, value_of(t.twist, batch_order, x), t.twist[0]);
  at.store(l.twist, twist);
  at.store(l.omega, select(done, value_of(t.omega, batch_order, x) / h, at.load(l.omega)));
  at.store(batch.loop.read_twist, twist * at.load(l.reads));
}

}  // namespace zerocount::batch
