#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/friction/parameters.hpp"
#include "core/friction/presliding/spring.hpp"
#include "core/motion/parameters.hpp"
#include "core/trial/parameters.hpp"
#include "tests/benchmarks/peers/motion_law.hpp"

namespace zerocount::testing {

/// Events at which the equations of motion change; each of them ends a step of an integrator.
enum class PeerEvent {
  none,
  reversal,   ///< the elongation of the spring changes its direction
  closure,    ///< a hysteresis loop closes: the branch of the spring ends
  creep,      ///< creep of the contact starts or ends
  breakaway,  ///< the contact (hook) starts to slide
  stop        ///< the slide ends: the contact sticks again
};

/// Speed ε of the elongation below which it counts as at rest, rad.
inline constexpr double rest_limit = 4e-13;
inline constexpr double tolerance_after_breakaway =
    30.0;  ///< Ratio of the integrator's tolerance after the first breakaway to the tolerance before it

/// The friction contact of a trial, for an ordinary integrator: on which branch of the spring it is, which
/// event can happen next, and what changes then. The integrator asks `law` for slopes, and says which event
/// it came to.
///
/// Rest rule: where |dxs/dt| < ε·ω₀ and |d²xs/dt²| < ε·ω₀², the elongation is held until the next sampling
/// instant, and creep follows its closed form for a constant σ. The neglected motion is of the size of ε·(k1
/// + k2)/k1.
class PeerContact {
 public:
  /// Creates the contact of a trial at its start.
  /// @param parameters must outlive the contact
  explicit PeerContact(const trial::TrialParameters& parameters);

  const PeerMotionLaw& law() const { return law_; }
  bool sliding() const { return law_.sliding; }
  bool resting() const { return resting_; }

  PeerState start() const { return {spring_.elongation(), 0.0, hardening_at_anchor_}; }
  /// Rotor angle θ, rad.
  double theta(const PeerState& y) const { return sliding() ? y[0] : hook_ + y[0] + extension(y); }
  double omega(const PeerState& y) const { return y[1] * law_.per_tau; }  ///< Angular velocity ω, rad/s
  /// Creep extension xp, rad; that of the last contact while the contact slides.
  double extension(const PeerState& y) const {
    const double grown = sliding() ? 0.0 : y[2] - hardening_at_anchor_;
    return extension_at_anchor_ + law_.side * grown;
  }
  /// Hardening xh, rad; that of the last contact while the contact slides.
  double hardening(const PeerState& y) const { return sliding() ? hardening_at_anchor_ : y[2]; }
  double direction() const { return direction_; }  ///< direction of the spring's elongation: 1 or −1
  std::int64_t depth() const { return static_cast<std::int64_t>(spring_.depth()); }
  /// Largest number of remembered reversals since forget_deepest().
  std::int64_t deepest() const { return deepest_; }
  void forget_deepest() { deepest_ = depth(); }
  std::int64_t breakaways() const { return breakaways_; }  ///< number of breakaways since the start

  /// Applies the torque (N m) from now on; begin() must follow.
  void set_torque(double torque) { law_.torque = torque; }
  /// Finds out what moves from the state `y` on: rest, direction of the elongation, creep, breakaway. To be
  /// called at the start, after every change of the torque, after every event and after every rest.
  void begin(PeerState& y);
  /// Advances the state `y` by `duration` (s) at rest, where only creep goes on.
  void hold(PeerState& y, double duration);
  /// Changes the contact as the event, which happens at `y`, does; begin() must follow.
  void happen(PeerEvent event, PeerState& y);

  // Guards: positive before their event and negative after it; infinite where the event cannot come.
  double reversal_guard(const PeerState& slope) const { return direction_ * slope[0]; }
  double closure_guard(double elongation) const { return direction_ * (branch_end_ - elongation); }
  double creep_guard(double sigma, double hardening) const {
    if (law_.alpha == 0.0) return creep_onset_torque_ - std::abs(sigma);
    // Beyond σ = 0 the driving term counts as negative: creep ends before it.
    return (sigma * law_.side < 0.0 ? -1.0 : 1.0) * law_.hardening_limit(sigma) - hardening;
  }
  /// Guard of the breakaway: its zero is the event.
  /// @param hook_torque torque σ + c·ω on the contact, N m
  double breakaway_guard(double hook_torque, const PeerState& y) const {
    return hook_torque > 0.0 ? std::max(contact_.breakaway - hook_torque, -y[1])
                             : std::max(contact_.breakaway + hook_torque, y[1]);
  }
  double stop_guard(const PeerState& y) const { return law_.sign * y[1]; }

  double breakaway_torque() const { return contact_.breakaway; }  ///< Breakaway torque of the contact, N m

  // The Stribeck peak of a slide that comes to ω = 0 can lie between the stages of one step, and be missed by
  // its error estimate with them.
  bool slows_down(const PeerState& slope) const { return law_.sign * slope[1] <= 0.0; }
  /// The scaled velocity ω·τ (rad) below which the Stribeck peak of the friction matters for the step length.
  double peak_in_sight() const { return 5.0 / law_.softening_rate; }
  /// Longest step (s) of the integrator below peak_in_sight(): ω changes by no more than the width of the
  /// Stribeck peak.
  double longest_step_over_peak() const {
    const double steepest = (std::abs(law_.torque) + contact_.breakaway) * law_.tau_per_inertia;
    return 1.0 / (law_.softening_rate * steepest);
  }

 private:
  void adopt_contact(const friction::FrictionParameters& friction);
  void adopt_branch();
  void adopt_direction(int direction, const PeerState& y);
  double creep_rate(double sigma, const PeerState& y);
  void start_creep(double sigma, const PeerState& y);
  void end_creep(const PeerState& y);
  void break_away(double direction, PeerState& y);
  void re_stick(PeerState& y);

  motion::PlantParameters plant_;
  const friction::FrictionAlongRotor& friction_;
  double position_;

  friction::FrictionParameters contact_;
  friction::HystereticSpring spring_;
  PeerMotionLaw law_;
  double frequency_{0.0};  ///< frequency ω₀ = √((k1 + k2)/J), rad/s
  double direction_{0.0};
  /// Elongation at which the branch of the spring ends, rad; infinite if it does not end.
  double branch_end_{0.0};
  double creep_onset_torque_{0.0};   ///< torque above which creep starts, N m
  double extension_at_anchor_{0.0};  ///< creep extension xp when creep last started or ended, rad
  double hardening_at_anchor_{0.0};  ///< hardening xh when creep last started or ended, rad
  double hook_{0.0};  ///< position of the hook, where the spring is attached to the contact, rad
  double breakaway_spring_torque_{0.0};  ///< spring torque σb at which the contact breaks away, N m
  bool resting_{false};
  double rest_torque_{0.0};    ///< spring torque σ during the last rest, N m
  double rest_duration_{0.0};  ///< duration of the last rest, s
  /// Fraction of the creep that the last rest completes: 1 − exp(−α·rest_duration).
  double rest_relaxation_{0.0};
  std::int64_t deepest_{0};
  std::int64_t breakaways_{0};
};

}  // namespace zerocount::testing
