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

/// The kinks of the motion, each of which ends a step of an integrator.
enum class PeerEvent {
  none,
  reversal,   ///< the elongation turns
  closure,    ///< the branch ends
  creep,      ///< creep starts or ends
  breakaway,  ///< the hook starts to slide
  stop        ///< the slide ends
};

inline constexpr double rest_limit = 4e-13;  ///< ε of the rest rule, rad
inline constexpr double tolerance_after_breakaway =
    30.0;  ///< ratio of the tolerance to that before the first breakaway

/// The contact of a trial, for an integrator of the ordinary kind: on which branch it is, what can happen
/// next, and what happens then. The integrator asks `law` for slopes, and says which event it came to.
///
/// Rest rule: where |dxs/dt| < ε·ω₀ and |d²xs/dt²| < ε·ω₀², the elongation is held until the next sampling
/// instant, and creep follows its closed form for a constant σ. What is left out is of the size of ε·(k1 +
/// k2)/k1.
class PeerContact {
 public:
  /// @param parameters must outlive the contact.
  explicit PeerContact(const trial::TrialParameters& parameters);

  const PeerMotionLaw& law() const { return law_; }
  bool sliding() const { return law_.sliding; }
  bool resting() const { return resting_; }

  PeerState start() const { return {spring_.elongation(), 0.0, hardening_at_anchor_}; }
  double theta(const PeerState& y) const { return sliding() ? y[0] : hook_ + y[0] + extension(y); }  ///< rad
  double omega(const PeerState& y) const { return y[1] * law_.per_tau; }  ///< rad/s
  /// xp, rad; of the last contact while the hook slides.
  double extension(const PeerState& y) const {
    const double grown = sliding() ? 0.0 : y[2] - hardening_at_anchor_;
    return extension_at_anchor_ + law_.side * grown;
  }
  /// xh, rad; of the last contact while the hook slides.
  double hardening(const PeerState& y) const { return sliding() ? hardening_at_anchor_ : y[2]; }
  double direction() const { return direction_; }  ///< direction of the elongation
  std::int64_t depth() const { return static_cast<std::int64_t>(spring_.depth()); }
  std::int64_t deepest() const { return deepest_; }  ///< largest depth since forget_deepest()
  void forget_deepest() { deepest_ = depth(); }
  std::int64_t breakaways() const { return breakaways_; }  ///< number of breakaways since the start

  /// Applies the torque (N m) from now on; begin() must follow.
  void set_torque(double torque) { law_.torque = torque; }
  /// Settles what moves from the state `y` on: rest, direction, creep, breakaway. To be called at the start,
  /// after every change of the torque, after every event and after every rest.
  void begin(PeerState& y);
  /// Takes `y` through `duration` (s) of rest.
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
  /// @param hook_torque σ + c·ω, N m.
  double breakaway_guard(double hook_torque, const PeerState& y) const {
    return hook_torque > 0.0 ? std::max(contact_.breakaway - hook_torque, -y[1])
                             : std::max(contact_.breakaway + hook_torque, y[1]);
  }
  double stop_guard(const PeerState& y) const { return law_.sign * y[1]; }

  double breakaway_torque() const { return contact_.breakaway; }  ///< N m

  // The Stribeck peak of a slide that comes to ω = 0 can lie between the stages of one step, and be missed by
  // its error estimate with them.
  bool slows_down(const PeerState& slope) const { return law_.sign * slope[1] <= 0.0; }
  /// ω·τ (rad) at which the peak comes into sight.
  double peak_in_sight() const { return 5.0 / law_.softening_rate; }
  /// Longest step (s) from there on: ω changes by no more than the peak's width.
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
  double frequency_{0.0};  ///< ω₀, rad/s
  double direction_{0.0};
  double branch_end_{0.0};               ///< rad; infinitely far ahead where the branch has none
  double creep_onset_torque_{0.0};       ///< N m
  double extension_at_anchor_{0.0};      ///< xp where creep last started or ended, rad
  double hardening_at_anchor_{0.0};      ///< xh there, rad
  double hook_{0.0};                     ///< position of the hook, rad
  double breakaway_spring_torque_{0.0};  ///< σb, N m
  bool resting_{false};
  double rest_torque_{0.0};      ///< σ, N m
  double rest_duration_{0.0};    ///< duration of the last rest, s
  double rest_relaxation_{0.0};  ///< 1 − exp(−α·rest_duration)
  std::int64_t deepest_{0};
  std::int64_t breakaways_{0};
};

}  // namespace zerocount::testing
