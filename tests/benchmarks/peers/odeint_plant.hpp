#pragma once

#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "tests/benchmarks/peers/contact.hpp"

namespace zerocount::testing {

/// The rotor on its friction contact, integrated by Boost.odeint: its dopri5 with step-size control, and its
/// dense output, in which events are located and the samples are read.
class OdeintPlant {
 public:
  /// @param parameters must outlive the plant.
  /// @param tolerance largest local error of a step before the first breakaway, rad.
  OdeintPlant(const trial::TrialParameters& parameters, double tolerance);

  /// Applies the torque (N m) from now on.
  void set_torque(double torque);
  /// Advances the motion by `duration` (s).
  /// @throws std::runtime_error if the integration fails
  void advance(double duration);

  double theta() const { return contact_.theta(now_); }  ///< Rotor angle θ, rad
  const PeerState& state() const { return now_; }
  const PeerContact& contact() const { return contact_; }
  PeerContact& contact() { return contact_; }

 private:
  using Dopri5 = boost::numeric::odeint::runge_kutta_dopri5<PeerState, double, PeerState, double,
                                                            boost::numeric::odeint::array_algebra>;
  using Controlled = boost::numeric::odeint::controlled_runge_kutta<Dopri5>;

  static Controlled controlled(double tolerance);
  void restart();
  void relax();
  void step(double until);
  double longest_step() const;
  PeerState state_at(double time) const;
  PeerState last_valid_state() const;

  // In odeint_kinks.cpp.
  void look_for_events();
  void look_for_reversal();
  void look_for_breakaway();
  double elongation_acceleration(const PeerState& y, const PeerState& slope, double softness) const;
  template <class Guard>
  void offer(PeerEvent event, Guard guard, double end);
  void take(PeerEvent event, double time);

  PeerContact contact_;
  double tolerance_;
  Controlled stepper_;
  bool relaxed_{false};
  PeerState now_{};
  double clock_{0.0};   ///< time since the last restart of the integration, s
  bool stood_{false};   ///< the torque did not change at the last sample
  double proposed_{0};  ///< step length that the integrator proposes next, s

  // The last step, from old to new. Its dense output is good up to valid_until_, where pending_ happens.
  double old_time_{0.0};
  double new_time_{0.0};
  double valid_until_{0.0};
  PeerEvent pending_{PeerEvent::none};
  PeerState old_{};
  PeerState new_{};
  PeerState old_slope_{};
  PeerState new_slope_{};
  double old_softness_{1.0};
  double new_softness_{1.0};
};

}  // namespace zerocount::testing
