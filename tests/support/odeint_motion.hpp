#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::testing {

/// Numbers of the friction contact's events so far, by kind.
struct EventCounts {
  std::int64_t reversals{0};
  std::int64_t closures{0};
  std::int64_t creep_kinks{0};
  std::int64_t breakaways{0};
  /// Breakaways in which the damper alone overcame the hook, while the spring pulled the other way.
  std::int64_t breakaways_against_spring{0};
  std::int64_t resticks{0};
};

/// The rotor on its friction contact, integrated by Boost.odeint's Fehlberg 7(8) in 64-bit-mantissa
/// arithmetic, with every kink located in time. It is written from the equations alone, so that it can judge
/// another integrator. It is slow and not meant for studies. It has all three friction models, and starts of
/// every kind.
///
/// Rest rule: if, at the start of an interval of constant torque, the speed of the elongation is below
/// δ·ω₀ and its acceleration below δ·ω₀² (δ = 1e-17 rad, ω₀ = √((k1 + k2)/J)), reversals are not looked for
/// during that interval. The neglected oscillation is below 3e-12 count.
class OdeintMotion {
 public:
  using Real = long double;
  /// State of the motion: travel since the contact formed (rad), ω (rad/s), xp (rad), xh (rad).
  using State = std::array<Real, 4>;

  /// Torque in an interval, with the exponential lag of an amplifier: u(t) = settled + (now −
  /// settled)·exp(−rate·t), N m.
  struct Torque {
    Real now{0};
    Real settled{0};
    Real rate{0};  ///< rate of the amplifier, 1/s; 0: the torque stays at `now`
  };

  /// @param history torques (N m) to which the spring was loaded before t = 0, after the preload; finally it
  /// was unloaded to 0
  explicit OdeintMotion(const trial::TrialParameters& parameters, const std::vector<double>& history = {});

  /// Moves the rotor under `torque` for `duration` (s).
  void advance(const Torque& torque, Real duration);
  /// Moves the rotor under a constant torque (N m) for `duration` (s).
  void advance(Real torque, Real duration) { advance({torque, torque, 0}, duration); }

  Real theta() const { return origin_ + state_[0]; }  ///< rotor angle, rad
  const State& state() const { return state_; }
  std::int64_t depth() const { return static_cast<std::int64_t>(stack_.size()); }
  bool sliding() const { return sliding_; }
  const EventCounts& events() const { return events_; }

 private:
  enum Event {
    reversal,
    closure,
    virgin_origin,
    creep_kink,
    breakaway_up,
    breakaway_down,
    stop,
    event_count
  };
  using Guards =
      std::array<Real, event_count>;  ///< each falls below zero at its event; +∞ if the event cannot occur

  struct Contact {  ///< present friction contact: its parameters, as in core/friction/parameters.hpp
    Real k1, k2, beta, alpha, lambda, n, breakaway, coulomb_ratio, stribeck_velocity;
  };
  struct Crossing {
    Real time{-1};
    Event event{event_count};
  };

  static int sign(Real value) { return (value > 0) - (value < 0); }

  Contact contact_at(Real theta) const;
  Real branch(Real u) const;
  Real branch_slope(Real u) const;
  Real inverse_branch(Real torque) const;
  Real elongation(const State& y) const { return y[0] + offset_ - y[2]; }
  Real spring_torque(const State& y) const;
  Real stiffness(const State& y) const;
  Real driving(Real sigma) const;
  Real hardening_rate(const State& y, Real sigma) const;
  Real torque_at(Real time) const;  // time from the present instant on, here and in slopes
  State slopes(const State& y, Real time) const;
  Real elongation_acceleration(const State& y) const;

  bool closure_ahead(Real& target) const;
  Guards guards(const State& y) const;
  State state_after(Real time) const;
  /// Longest step, s, that does not skip a Stribeck peak or an oscillation.
  Real longest_step() const;
  Real longest_step_at_constant_torque() const;
  Crossing first_crossing(const State& end, Real length) const;
  Real locate(Event event, Real low, Real low_value, Real high) const;
  void happen(Event event);

  void stretch(const std::vector<double>& torques);
  Real standing_time(Real longest) const;
  void settle();
  void reverse();
  void close_loops();
  void break_away(int sign);
  void stick();

  motion::PlantParameters plant_;
  friction::FrictionAlongRotor friction_;
  Real position_;
  Contact contact_{};
  Real frequency_{0};  ///< frequency ω₀ = √((k1 + k2)/J) of the rotor on the spring, rad/s
  Torque torque_;      ///< torque on the rotor since the start of the interval, N m
  Real clock_{0};      ///< time since the start of the present torque's interval, s
  Real origin_{0};     ///< rotor angle θ at which the contact formed, rad
  Real offset_{0};     ///< elongation of the spring when the contact formed, rad
  State state_{};
  std::vector<std::pair<Real, Real>> stack_;  ///< (elongation, torque) of the surviving reversal points
  int direction_{0};    ///< direction of the elongation or slide; 0 before the first motion
  int virgin_sign_{1};  ///< sign of the elongation on the virgin curve: 1 or −1
  bool coulomb_{false};
  bool sliding_{false};
  bool resting_{false};
  bool frozen_{false};
  bool creeping_{true};
  Real held_torque_{0};  ///< spring torque at the last breakaway, N m
  Real step_{0};         ///< length of the next integration step to be tried, s
  EventCounts events_;
};

}  // namespace zerocount::testing
