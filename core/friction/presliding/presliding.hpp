#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/friction/law.hpp"
#include "core/friction/presliding/creep.hpp"
#include "core/friction/presliding/residual_oscillation.hpp"
#include "core/friction/presliding/spring.hpp"
#include "core/friction/presliding/sticking.hpp"

namespace zerocount::friction {

/// State of motion of the rotor and its pre-sliding contact, without the reversal points of the spring.
struct PlantMotion {
  double elongation{0.0};  ///< Elongation xs of the contact's spring, rad
  double omega{0.0};       ///< Velocity ω of the rotor, rad/s
  CreepState creep{};
  bool creeping{false};            ///< Whether the contact creeps
  double creep_onset_torque{0.0};  ///< Absolute spring torque |σ| at which creep sets in while it is off, N m
  double hook{0.0};  ///< Position of the hook, the end of the friction spring that sticks to the ground, rad
  bool sliding{false};
  double slide_theta{0.0};      ///< Rotor angle θ while the contact slides, rad
  double slide_direction{0.0};  ///< Direction in which the contact slides, −1 or 1
  double breakaway_spring_torque{
      0.0};  ///< Torque σb of the contact's spring when the present slide began, N m
};

/// The model of the paper: pre-sliding motion while the hook sticks (Sticking; paper, eq. 4, with creep), and
/// sliding after breakaway (Slide; paper, eq. 3).
///
/// Rest rule. Without one, an oscillation would decay for ever, until rounding decided the sign of the
/// elongation rate. Let δσ and δω be the deviations of σ and ω from quasi-static creep under the present
/// torque (CreepAtRest; without creep σ = u and ω = 0), ε = MotionTolerance::rest, ωn² = (k1 + k2)/J, and A
/// the amplitude with
///
///   ((δσ + c·δω)/J)² + (ωn·δω)² = (A·ωn²)².
///
/// If A < ε and |δσ| < 2ε·dσ/dxs, σ and ω are set to those of CreepAtRest, which the rotor follows while
/// the torque is constant. This neglects an oscillation of amplitude ε.
///
/// At a reversal the rotor comes to rest earlier, where β·A² < ε: a loop of the spring of size A is open by
/// about β·A², so the remaining oscillation is a ResidualOscillation about CreepAtRest. The spring remembers
/// only its first reversal. This does not apply where creep starts or ends, or the hook breaks away, within
/// twice the amplitude.
///
/// Both conditions are on the energy of the oscillation, which only falls, and the second holds at reversals
/// only. The last reversal that the spring remembers is therefore independent of the steps of integration.
///
/// Under a varying torque the elongation is held while |dxs/dt| < ε·ωn and |d²xs/dt²| < ε·ωn², with ε =
/// MotionTolerance::elongation, from half of that acceleration until the torque has brought it to the full
/// value; creep follows its exact solution at constant torque. The elongation is then never further than
/// ε·(k1 + k2)/k1 from the one that balances the torque.
class PreslidingFriction {
 public:
  static constexpr std::string_view word = "presliding";
  static constexpr std::array<ContactField, 9> contact_parameters{&FrictionParameters::breakaway,
                                                                  &FrictionParameters::coulomb_ratio,
                                                                  &FrictionParameters::stribeck_velocity,
                                                                  &FrictionParameters::k1,
                                                                  &FrictionParameters::k2,
                                                                  &FrictionParameters::beta,
                                                                  &FrictionParameters::alpha,
                                                                  &FrictionParameters::lambda,
                                                                  &FrictionParameters::n};
  static constexpr bool has_presliding_motion = true;
  static constexpr bool has_presliding_damping = true;
  static constexpr bool has_sliding_damping = true;
  static constexpr bool remembers_loading = true;
  static constexpr Breakaway breakaway = Breakaway::of_hook;
  static constexpr auto linear_contacts = contacts_of_spring;

  PreslidingFriction(const motion::PlantParameters& plant, FrictionAlongRotor friction,
                     const motion::PlantStart& start, motion::MotionTolerance tolerance);

  double step(const motion::TorqueCourse& torque, double duration) {
    return sliding_ ? slide(torque, duration) : stick(torque, duration);
  }

  // For an engine that integrates the motion itself and uses this class for rare events.
  PlantMotion motion() const;
  /// Sets the state of motion. The spring of `motion` must be on the same hysteresis branch as the present
  /// spring.
  void set_motion(const PlantMotion& motion);
  /// The contact breaks away: starts a slide in `direction` (−1 or 1).
  void break_away(double direction);
  /// Ends a slide, whose velocity has come to ω = 0: the end of the friction spring sticks again, in a new
  /// contact.
  void re_stick();
  /// State of rest of the rotor under a constant torque: creep, and a small residual oscillation.
  struct Rest {
    double torque;                    ///< Constant torque u on the rotor, N m
    CreepAtRest creep;                ///< Quasi-static creep since the rest began
    CreepState start;                 ///< State of creep (extension and hardening) when the rest began
    ResidualOscillation oscillation;  ///< Small decaying oscillation about the quasi-static creep
    double time;                      ///< Time since the rest began, s
  };

  /// Applies the rest rule under the constant torque `torque` (N m).
  /// @returns whether the rotor is at rest. Then step() with that torque advances over any duration at once.
  /// @param at_reversal whether the elongation rate dxs/dt is exactly zero.
  /// @param load the second mass; null without one
  bool come_to_rest(double torque, bool at_reversal, motion::Load* load = nullptr);
  /// The present state of rest; empty while the rotor is not at rest.
  const std::optional<Rest>& rest() const { return rest_; }
  /// State of the creep at a later time while the rotor is at rest.
  struct RestPoint {
    double time;    ///< Time since the rest began, s
    double rate;    ///< Rate of creep dxh/dt, rad/s; 0 without creep
    double growth;  ///< Growth of the hardening, and of |plastic extension|, by creep since the rest began,
                    /// < rad
    ResidualOscillation::State oscillation;
  };
  /// State of the creep after another `time` (s) at rest. Call only while the rotor is at rest.
  RestPoint point_at_rest(double time) const;
  /// Rotor angle θ (rad) at a point in time at rest. Call only while the rotor is at rest.
  double theta_at(const RestPoint& point) const;
  /// Advances the rotor at rest to a point in time at rest. Call only while the rotor is at rest.
  void go_to(const RestPoint& point);
  /// The present deviation of the motion from quasi-static creep; zero except at rest.
  const ResidualOscillation::State& oscillation() const { return oscillation_; }
  /// The hysteretic spring of the contact. At rest, its elongation is that of quasi-static creep, without the
  /// residual oscillation.
  HystereticSpring& spring() { return spring_; }

  /// Angle θ of the rotor, rad.
  double theta() const { return sliding_ ? slide_theta_ : hook_ + elongation() + creep_.extension; }
  /// Velocity ω of the rotor, rad/s.
  double omega() const { return omega_; }
  /// State of creep (plastic extension and hardening) in the present contact or, while the hook slides, in
  /// the last one.
  const CreepState& creep() const { return creep_; }
  const HystereticSpring& spring() const { return spring_; }
  const FrictionParameters& contact() const { return contact_; }
  bool sliding() const { return sliding_; }

  /// Number of times since the start that the contact has broken away into a slide.
  std::int64_t breakaways() const { return breakaways_; }
  /// Largest number of reversal points on the spring's stack since the last forget_deepest().
  std::int64_t deepest() const { return deepest_; }
  void forget_deepest() { deepest_ = depth(); }
  std::int64_t depth() const { return static_cast<std::int64_t>(spring_.depth()); }

 private:
  /// Motion of the contact's spring: its elongation rate dxs/dt (rad/s), and d²xs/dt² (rad/s²; exact where
  /// dxs/dt is zero).
  struct Elongation {
    double rate;
    double acceleration;
  };

  /// Deviation of the rotor's motion from quasi-static creep under the present torque.
  struct Excess {
    CreepAtRest creep;  ///< The quasi-static creep under the present torque
    double torque;      ///< Deviation δσ of the spring torque, N m
    double velocity;    ///< Deviation δω of the velocity, rad/s
    double amplitude;   ///< Amplitude A of the oscillation about quasi-static creep, rad
  };

  // Each returns the time used, at most `duration`.
  double stick(const motion::TorqueCourse& torque, double duration);
  double slide(const motion::TorqueCourse& torque, double duration);

  bool load_is_quiet(const motion::TorqueCourse& torque, double creep_rate_now) const;
  Elongation elongation_under(double torque, double creep_rate_now) const;
  bool begin_rest(double torque, const Elongation& elongation, bool was_at_rest, bool may_oscillate);
  std::optional<Excess> excess_over_rest(double torque, const Elongation& elongation,
                                         double max_amplitude) const;
  bool oscillates_freely(double torque, const Excess& excess) const;
  OscillationLaw oscillation_law(const Excess& excess) const;
  ResidualOscillation begin_oscillation(const Excess& excess);
  CreepState slow_creep(double sign) const;
  double neglected_creep(const OscillationLaw& law, const Excess& excess) const;
  void settle(const Excess& excess, bool was_at_rest);
  std::optional<CreepAtRest> slow_motion(double torque, double sign) const;
  double elongation() const { return spring_.elongation() + oscillation_.elongation; }
  bool leave_rest();
  double switch_creep();
  bool at_rest(const Elongation& elongation) const;
  double time_at_rest(const Elongation& elongation, const motion::TorqueCourse& torque,
                      double duration) const;
  int breakaway_direction(double torque) const;
  void pass(Sticking::Event event);
  void hold_at_rest(double duration);
  void end_creep();
  double creep_rate() const;

  motion::PlantParameters plant_;
  FrictionAlongRotor friction_;
  double position_;
  motion::MotionTolerance tolerance_;

  FrictionParameters contact_;
  std::int64_t contact_number_{0};
  HystereticSpring spring_;
  CreepState creep_;
  bool creeping_{false};
  double creep_onset_torque_{0.0};  // |σ| at which creep starts, while it is off
  double hook_{0.0};
  double omega_{0.0};
  std::optional<Rest> rest_;
  ResidualOscillation::State oscillation_{0.0, 0.0, 0.0};  // zero except at rest

  bool sliding_{false};
  double slide_theta_{0.0};
  double slide_direction_{0.0};
  double breakaway_spring_torque_{0.0};  // σb

  std::int64_t breakaways_{0};
  std::int64_t deepest_{0};
};

/// PreslidingFriction without creep: the rate α of creep is 0 in every contact.
class SpringFriction : public PreslidingFriction {
 public:
  using PreslidingFriction::PreslidingFriction;
  static constexpr std::string_view word = "spring";
  static constexpr std::array<ContactField, 6> contact_parameters{&FrictionParameters::breakaway,
                                                                  &FrictionParameters::coulomb_ratio,
                                                                  &FrictionParameters::stribeck_velocity,
                                                                  &FrictionParameters::k1,
                                                                  &FrictionParameters::k2,
                                                                  &FrictionParameters::beta};
};

}  // namespace zerocount::friction
