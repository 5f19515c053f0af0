#pragma once

#include <array>

#include "core/friction/law.hpp"
#include "core/motion/parameters.hpp"
#include "core/motion/torque_course.hpp"

namespace zerocount::friction {

/// State of motion of a rotor without friction.
struct FreeMotion {
  double theta{0.0};  ///< Rotor angle θ, rad
  double omega{0.0};  ///< Rotor velocity ω, rad/s
};

/// The rotor of FrictionModel::none, an air bearing, after the time t (s) from `start` under `torque`:
///
///   J·dω/dt = u(t) − c·ω,   dθ/dt = ω,   u(t) = U + (u(0) − U)·e^(−rt),
///
/// c = PlantParameters::presliding_damping. In closed form, with a = c/J and divided differences of exp,
///
///   ω(t) = ω(0)·e^(−at) + U/J·t·exp[0, −at] + (u(0) − U)/J·t·exp[−at, −rt]
///   θ(t) = θ(0) + ω(0)·t·exp[0, −at] + U/J·t²·exp[0, 0, −at] + (u(0) − U)/J·t²·exp[0, −at, −rt].
///
/// With c = 0 the rotor is free.
FreeMotion free_motion(const motion::PlantParameters& plant, const FreeMotion& start,
                       const motion::TorqueCourse& torque, double t);

/// An air bearing: J·dω/dt = u − c·ω and nothing else, by free_motion() where there is neither a load nor a
/// varying disturbance. The rotor always slides, without a contact that could break away.
class NoFriction : public WithoutCreepAndReversals {
 public:
  static constexpr std::string_view word = "none";
  static constexpr std::array<ContactField, 0> contact_parameters{};
  static constexpr bool has_presliding_motion = false;
  static constexpr bool has_presliding_damping = true;
  static constexpr bool has_sliding_damping = false;
  static constexpr bool remembers_loading = false;
  static constexpr Breakaway breakaway = Breakaway::never;
  static LinearContacts linear_contacts(const motion::PlantParameters& plant, const FrictionAlongRotor&,
                                        const FrictionParameters&) {
    return {{"without friction", 0.0, plant.presliding_damping, true}};
  }

  NoFriction(const motion::PlantParameters& plant, const FrictionAlongRotor&, const motion::PlantStart& start,
             const motion::MotionTolerance& tolerance)
      : plant_(plant), tolerance_(tolerance.elongation), motion_{0.0, start.velocity} {}

  double step(const motion::TorqueCourse& torque, double duration) {
    if (motion::is_coupled(torque)) return step_coupled(torque, duration);
    motion_ = free_motion(plant_, motion_, torque, duration);
    return duration;
  }

  double theta() const { return motion_.theta; }
  double omega() const { return motion_.omega; }
  static bool sliding() { return true; }
  static std::int64_t breakaways() { return 0; }

 private:
  /// Advances a rotor on which a second mass or a varying disturbance d acts by one Taylor step: J·dω/dt = u
  /// + d − Ts − c·ω.
  /// @returns the time used, at most `duration`, s.
  double step_coupled(const motion::TorqueCourse& torque, double duration);

  motion::PlantParameters plant_;
  double tolerance_;
  FreeMotion motion_;
};

}  // namespace zerocount::friction
