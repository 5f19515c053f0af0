#pragma once

#include <array>

#include "core/friction/law.hpp"
#include "core/friction/sliding/sliding.hpp"

namespace zerocount::friction {

/// State of motion of a rotor with Coulomb friction, for an engine that integrates the motion itself.
struct CoulombMotion {
  double theta;      ///< Rotor angle θ, rad
  double omega;      ///< Rotor velocity ω, rad/s
  double direction;  ///< Direction of the slide, −1 or 1; 0 while the rotor stands
  bool spent;        ///< Whether a slide has just ended where it began (StandingContact::spent)
};

/// Amonton–Coulomb friction with a static level. The rotor angle θ is constant while the torque is |u| ≤ Fs =
/// breakaway. When |u| passes Fs, the rotor slides towards sgn(u), as described at Slide, until ω = 0. There
/// a new contact forms, with the friction parameters of that place.
class CoulombFriction : public WithoutCreepAndReversals {
 public:
  static constexpr std::string_view word = "coulomb";
  static constexpr std::array<ContactField, 3> contact_parameters{&FrictionParameters::breakaway,
                                                                  &FrictionParameters::coulomb_ratio,
                                                                  &FrictionParameters::stribeck_velocity};
  static constexpr bool has_presliding_motion = false;
  static constexpr bool has_presliding_damping = false;
  static constexpr bool has_sliding_damping = true;
  static constexpr bool remembers_loading = false;
  static constexpr Breakaway breakaway = Breakaway::of_hook;
  static LinearContacts linear_contacts(const motion::PlantParameters& plant, const FrictionAlongRotor&,
                                        const FrictionParameters&) {
    return {sliding_contact(plant)};
  }

  /// Starts the rotor. It slides at the start wherever velocity ≠ 0.
  CoulombFriction(const motion::PlantParameters& plant, FrictionAlongRotor friction,
                  const motion::PlantStart& start, const motion::MotionTolerance& tolerance);

  double step(const motion::TorqueCourse& torque, double duration);

  CoulombMotion motion() const { return {theta_, omega_, sliding_ ? direction_ : 0.0, spent_}; }
  /// Sets the state of motion, within the present contact.
  void set_motion(const CoulombMotion& motion);
  /// Ends the slide: the rotor stands, and a new contact forms at the present angle θ.
  void stand_still();

  double theta() const { return theta_; }
  double omega() const { return omega_; }
  bool sliding() const { return sliding_; }
  std::int64_t breakaways() const { return breakaways_; }
  const FrictionParameters& contact() const { return contact_; }

 private:
  double stand(const motion::TorqueCourse& torque, double duration);
  /// Advances a rotor at rest that a second mass or a varying disturbance acts on, by one step of at most
  /// `duration` (s).
  /// @returns the time used, s.
  double stand_coupled(const motion::TorqueCourse& torque, double duration);
  double slide(const motion::TorqueCourse& torque, double duration);
  bool torque_drives(double direction, const motion::TorqueCourse& torque) const;
  void break_away(double direction, bool at_level = false);

  motion::PlantParameters plant_;
  FrictionAlongRotor friction_;
  double position_;
  double tolerance_;
  FrictionParameters contact_;
  std::int64_t contact_number_{0};
  double theta_{0.0};
  double omega_;
  bool sliding_;
  double direction_;         // −1, 1
  bool at_level_{false};     // Slide::at_level, of a slide that is to begin
  double slide_start_{0.0};  // θ at the start of the slide, rad
  bool spent_{false};        // StandingContact::spent
  std::int64_t breakaways_{0};
};

}  // namespace zerocount::friction
