#pragma once

#include <cmath>
#include <cstddef>

#include "core/motion/parameters.hpp"
#include "core/numerics/power_series.hpp"

namespace zerocount::motion {

/// A second mass behind an elastic coupling, with its state:
///
///   JL·dωL/dt = Ts,   Ts = kL·δ + dL·(ω − ωL),   dδ/dt = ω − ωL,   δ = θ − θL.
///
/// −Ts acts on the rotor.
struct Load {
  LoadParameters parameters;
  double twist{0.0};  ///< δ, rad
  double omega{0.0};  ///< ωL, rad/s
};

/// Ts, N m. @param rotor_omega ω, rad/s.
inline double coupling_torque(const Load& load, double rotor_omega) {
  return load.parameters.stiffness * load.twist + load.parameters.damping * (rotor_omega - load.omega);
}

/// √(kL·J·JL/(J + JL)) + dL, N m s/rad: the largest coupling torque of an oscillation by its largest relative
/// velocity. @param inertia J of the rotor, kg m².
inline double torque_by_velocity(const LoadParameters& load, double inertia) {
  const double reduced = inertia * load.inertia / (inertia + load.inertia);
  return std::sqrt(load.stiffness * reduced) + load.damping;
}

/// Whether the coupling torque of any oscillation between load and rotor stays below `torque` (N m).
/// @param inertia J of the rotor, kg m². @param steady coupling torque of the motion without the oscillation,
/// N m.
inline bool is_quiet(const Load& load, double rotor_omega, double inertia, double torque, double steady) {
  return std::abs(load.parameters.stiffness * load.twist - steady) +
             torque_by_velocity(load.parameters, inertia) * std::abs(rotor_omega - load.omega) <
         torque;
}

/// The load moves as the rotor does from now on.
inline void follow_rotor(Load& load, double rotor_omega) {
  load.twist = 0.0;
  load.omega = rotor_omega;
}

/// Taylor series in time of a load.
struct LoadSeries {
  numerics::Series twist;  ///< δ, rad
  numerics::Series omega;  ///< ωL, rad/s
};

/// Sets the coefficients 0.
inline void start_series(LoadSeries& series, const Load& load) {
  series.twist[0] = load.twist;
  series.omega[0] = load.omega;
}

/// Computes the coefficients k + 1 from those of ω up to k. @returns coefficient k of Ts, N m.
inline double expand(LoadSeries& series, const LoadParameters& load, const numerics::Series& rotor_omega,
                     std::size_t k) {
  const double relative = rotor_omega[k] - series.omega[k];
  const double torque = load.stiffness * series.twist[k] + load.damping * relative;
  series.twist[k + 1] = relative * numerics::reciprocal[k + 1];
  series.omega[k + 1] = torque / load.inertia * numerics::reciprocal[k + 1];
  return torque;
}

/// The load after the time t (s) of its series.
inline void go_to(Load& load, const LoadSeries& series, double t) {
  load.twist = numerics::value_at(series.twist, t);
  load.omega = numerics::value_at(series.omega, t);
}

}  // namespace zerocount::motion
