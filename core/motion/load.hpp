#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/motion/disturbance.hpp"
#include "core/motion/parameters.hpp"
#include "core/numerics/power_series.hpp"

namespace zerocount::motion {

struct Load;

/// Interface of the friction between a second mass (load) and the frame, as the integrator uses it during a
/// Taylor step.
class LoadFriction {
 public:
  virtual ~LoadFriction() = default;
  virtual void start(const Load& load) = 0;
  /// Computes coefficient k of the friction's series.
  /// @param omega series of the load's velocity ωL, known up to coefficient k.
  /// @param torque coefficient k of the torque on the load without friction, N m.
  /// @returns coefficient k of JL·dωL/dt, N m.
  virtual double expand(const numerics::Series& omega, double torque, std::size_t k) = 0;
  /// The longest step (s), at most `duration`, in which the errors of the friction's own state stay within
  /// `tolerance` (rad).
  virtual double step_within(double tolerance, double duration) = 0;
  /// Time of the first event of the friction within `step`, s; empty if there is none. An event at 0 means
  /// that the series do not describe the motion to come.
  virtual std::optional<double> next_event(const numerics::Series& omega, double step) = 0;
  /// Advances the friction's state by `time` (s).
  /// @param at_event whether its event occurs at that time, and is to be processed.
  virtual void go_to(double time, bool at_event, Load& load) = 0;
};

/// A second mass behind an elastic coupling, with its state:
///
///   JL·dωL/dt = Ts + dist − cg·ωL − friction,   Ts = kL·h(δ) + dL·dδ/dt where h(δ) ≠ 0,
///   δ = θ + ε(θ) − θL,   dδ/dt = (1 + ε′(θ))·ω − ωL.
///
/// h is δ without the gap: δ − g/2 above g/2, δ + g/2 below −g/2, 0 between. −(1 + ε′(θ))·Ts acts on the
/// rotor, so that the coupling conserves power. The edge of the gap on which δ lies exactly belongs to the
/// side to which δ moves.
struct Load {
  LoadParameters parameters;
  double twist{0.0};                ///< Twist δ of the coupling, rad
  double omega{0.0};                ///< Angular velocity ωL of the load, rad/s
  std::vector<Ripple> error{};      ///< Kinematic error ε of the coupling as a function of the rotor's angle
  Disturbance disturbance{};        ///< Disturbance torque `dist` on the load, with ripples as functions of
                                    /// < the load's angle
  double rotor_theta{0.0};          ///< Rotor angle θ, rad; set before each step
  double time{0.0};                 ///< Time t of the disturbance, s; set before each step
  LoadFriction* friction{nullptr};  ///< Friction between load and frame; null without friction; set before
                                    /// < each step
};

/// Properties of the second mass (load) apart from a plain coupling: kinematic error, disturbance of the
/// load, and initial twist.
struct LoadSide {
  std::vector<Ripple> error{};
  Disturbance disturbance{};
  double twist{0.0};  ///< Twist δ of the coupling at t = 0, rad
};

/// Whether the coupling of the load has neither a gap nor a kinematic error, and nothing but the coupling
/// acts on the load. Then an oscillation of the load decays to rest with the rotor.
inline bool is_plain(const Load& load) {
  return load.parameters.gap == 0.0 && load.parameters.damping_to_ground == 0.0 && load.error.empty() &&
         load.disturbance.torque == 0.0 && !varies(load.disturbance) && load.friction == nullptr;
}

/// Angle θL of the load, rad.
/// @param theta rotor angle θ, rad.
inline double load_theta(const Load& load, double theta) {
  return load.error.empty() ? theta - load.twist : theta + value(load.error, theta) - load.twist;
}

/// Ratio of the velocity at the coupling to the velocity of the rotor, 1 + ε′(θ), with ε the kinematic error.
inline double transmission(const Load& load) {
  return load.error.empty() ? 1.0 : 1.0 + slope(load.error, load.rotor_theta);
}

/// The side of the coupling's gap on which the coupling is: 1 above, −1 below, 0 inside the gap.
/// @param twist δ, rad.
/// @param heading sign of the change of δ, which decides at an edge.
inline int side_of_gap(const LoadParameters& load, double twist, double heading) {
  const double half = 0.5 * load.gap;
  if (twist > half || (twist == half && heading > 0.0)) return 1;
  return twist < -half || (twist == -half && heading < 0.0) ? -1 : 0;
}

/// The torque with which the coupling acts on the rotor (to be subtracted), (1 + ε′)·Ts, N m.
/// @param rotor_omega velocity ω of the rotor, rad/s.
inline double coupling_torque(const Load& load, double rotor_omega) {
  const LoadParameters& p = load.parameters;
  const double ratio = transmission(load);
  const double rate = ratio * rotor_omega - load.omega;
  const int side = side_of_gap(p, load.twist, rate);
  if (p.gap > 0.0 && side == 0) return 0.0;
  return ratio * (p.stiffness * (load.twist - 0.5 * p.gap * side) + p.damping * rate);
}

/// Largest coupling torque of an oscillation, divided by its largest relative velocity: √(kL·J·JL/(J + JL)) +
/// dL, N m s/rad.
/// @param inertia J of the rotor, kg m².
inline double torque_by_velocity(const LoadParameters& load, double inertia) {
  const double reduced = inertia * load.inertia / (inertia + load.inertia);
  return std::sqrt(load.stiffness * reduced) + load.damping;
}

/// Whether the coupling torque of any oscillation between load and rotor stays below `torque` (N m). False
/// for a load that is not plain (is_plain()), because its oscillation has no known bound.
/// @param rotor_omega velocity ω of the rotor, rad/s.
/// @param inertia J of the rotor, kg m².
/// @param steady coupling torque of the motion without the oscillation, N m.
inline bool is_quiet(const Load& load, double rotor_omega, double inertia, double torque, double steady) {
  return is_plain(load) &&
         std::abs(load.parameters.stiffness * load.twist - steady) +
                 torque_by_velocity(load.parameters, inertia) * std::abs(rotor_omega - load.omega) <
             torque;
}

/// Sets a plain load to move with the rotor from now on, without an oscillation.
/// @param rotor_omega velocity ω of the rotor, rad/s.
inline void follow_rotor(Load& load, double rotor_omega) {
  load.twist = 0.0;
  load.omega = rotor_omega;
}

/// Taylor series in time of a load's motion, while the coupling stays on one side of its gap.
struct LoadSeries {
  numerics::Series twist;         ///< Twist δ of the coupling, rad
  numerics::Series omega;         ///< Velocity ωL of the load, rad/s
  numerics::Series torque;        ///< Coupling torque Ts, N m
  numerics::Series transmission;  ///< Transmission 1 + ε′(θ) of the coupling; unused without a kinematic
                                  /// < error
  int side{0};                    ///< Side of the coupling's gap: 1 above, −1 below, 0 inside the gap
  bool plain{true};
  std::optional<RippleSeries> error{};
  std::optional<DisturbanceSeries> disturbance{};
};

/// Sets the coefficients of order 0 of a load's series from its state.
/// @param heading sign of the change of δ.
void start_series(LoadSeries& series, const Load& load, double heading);

/// Computes the coefficients k + 1 of a load's series, given the coefficients of the rotor's velocity up to
/// k.
/// @returns coefficient k of the torque with which the coupling acts on the rotor, N m.
double expand(LoadSeries& series, const Load& load, const numerics::Series& rotor_omega, std::size_t k);

/// Direction (−1 or 1) in which the twist δ leaves the edge of the coupling's gap; 0 if δ does not start
/// exactly on an edge.
double heading_from_edge(const LoadSeries& series, const LoadParameters& load);

/// The first time within a step at which the twist δ comes to an edge of the coupling's gap.
struct EdgeOfGap {
  double time;   ///< Time from the start of the step, s
  double twist;  ///< Twist δ at that time, rad
};
std::optional<EdgeOfGap> next_edge(const LoadSeries& series, const LoadParameters& load, double step);

/// Advances the load to its state at the time t (s) of its series.
inline void go_to(Load& load, const LoadSeries& series, double t) {
  load.twist = numerics::value_at(series.twist, t);
  load.omega = numerics::value_at(series.omega, t);
}

}  // namespace zerocount::motion
