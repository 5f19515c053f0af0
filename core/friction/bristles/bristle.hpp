#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/friction/bristles/bristle_formulas.hpp"
#include "core/friction/law.hpp"
#include "core/friction/sliding/sliding.hpp"

namespace zerocount::friction {

/// Constants of an elastic bristle (Dahl, LuGre), with the velocities 8·ωs and 6.5·ωs between which the
/// Stribeck curve ceases to matter (slide_formulas.hpp).
struct BristleParameters : BristleConstants<double> {
  double fast;  ///< |ω| beyond which g(ω) = Fc to the last bit, rad/s; 0 if g is constant
  double slow;  ///< |ω| above which g(ω) = Fc to 6e-19 of Fs − Fc, rad/s; 0 if g is constant
};

BristleParameters bristle_parameters(double stiffness, double bristle_damping, double damping,
                                     const StribeckCurve& level);

using BristleSeries = BristleSeriesOf<numerics::Series>;

/// The motion of a rotor on a bristle, with a constant sign s of ω:
///
///   dz/dt = ω − σ0·s·ω·z/g(ω),   J·dω/dt = u − σ0·z − σ1·dz/dt − d·ω,   dθ/dt = ω.
///
/// It ends at ω = 0. Where g is constant the bristle comes to z = s·g/σ0 within rounding, and stays there: it
/// is *saturated*, J·dω/dt = u − s·g − d·ω, until |ω| falls to `slow`. Otherwise the bristle's time constant
/// g/(σ0·|ω|) would limit the steps of a fast rotor.
struct BristleMotion {
  using Expansion = BristleSeries;
  enum class Event { none, velocity_zero, slow_again };

  const BristleParameters& parameters;
  double direction;  ///< Direction s of the motion, −1 or 1
  bool saturated;
  double& theta;       ///< Rotor angle θ, rad
  double& omega;       ///< Rotor velocity ω, rad/s
  double& deflection;  ///< Deflection z of the bristle, rad

  /// Whether the friction level g(ω) equals Fc throughout the motion.
  bool has_constant_level() const { return saturated || parameters.level.excess == 0.0; }
  BristleSeries start() const;
  double expand(BristleSeries& s, std::size_t k, double torque) const;
  /// Longest step in which the truncation error of the bristle's deflection z stays within the tolerance of
  /// θ, because an error of z becomes an error of ω.
  /// @param duration longest step to consider, s.
  /// @returns s.
  static double step_of_state(const BristleSeries& series, double tolerance, double duration) {
    return motion::step_within(series.deflection, series.omega, series.exponent, tolerance, duration);
  }
  motion::NextEvent<Event> first_event(const BristleSeries& series, double step) const;
  void go_to(const BristleSeries& series, const motion::NextEvent<Event>& next);
};

/// Base of the friction laws of Dahl and LuGre, with one elastic bristle that stands for all asperities.
///
/// Rest rule: where bristle_rests() bounds all further travel under a constant torque u by
/// MotionTolerance::rest, the rotor is at rest, with ω = 0 and z = u/σ0, until the torque changes. A bristle
/// without damping never comes to rest.
class Bristle : public WithoutCreepAndReversals {
 public:
  static constexpr bool has_presliding_motion = true;
  static constexpr bool remembers_loading = false;
  static constexpr Breakaway breakaway = Breakaway::gradual;

  /// Starts with the deflection z = 0 or, if `start.sliding` and ω ≠ 0, with the deflection of steady
  /// sliding, sgn(ω)·g(ω)/σ0.
  Bristle(const BristleParameters& parameters, double inertia, const motion::PlantStart& start,
          const motion::MotionTolerance& tolerance);

  double step(const motion::TorqueCourse& torque, double duration);

  double theta() const { return theta_; }
  double omega() const { return omega_; }
  /// Whether the contact counts as sliding: its friction without the damping d is above 0.99·g(ω).
  bool sliding() const;
  static std::int64_t breakaways() { return 0; }
  double deflection() const { return deflection_; }  ///< Deflection z of the bristle, rad

 private:
  bool saturates(double direction);
  bool rests_under(double torque) const;

  BristleParameters parameters_;
  double inertia_;
  motion::MotionTolerance tolerance_;
  double theta_{0.0};
  double omega_;
  double deflection_;
  std::optional<double> rest_torque_;  // under which the rotor is at rest, N m
};

/// The law of Dahl (1968), with a viscous damping c:
///
///   dz/dt = ω − σ0·|ω|·z/Fc,   F = σ0·z + c·ω,   Fc = coulomb_ratio·breakaway.
class DahlFriction : public Bristle {
 public:
  static constexpr std::string_view word = "dahl";
  static constexpr std::array<ContactField, 3> contact_parameters{
      &FrictionParameters::breakaway, &FrictionParameters::coulomb_ratio, &FrictionParameters::sigma0};
  static constexpr bool has_presliding_damping = true;
  static constexpr bool has_sliding_damping = false;

  static LinearContacts linear_contacts(const motion::PlantParameters& plant, const FrictionAlongRotor&,
                                        const FrictionParameters& contact) {
    return {{"at sigma0", contact.sigma0, plant.presliding_damping},
            {"while sliding", 0.0, plant.presliding_damping, true}};
  }
  static BristleParameters bristle(const motion::PlantParameters& plant, const FrictionParameters& contact) {
    return bristle_parameters(contact.sigma0, 0.0, plant.presliding_damping,
                              {stribeck_curve(contact).coulomb, 0.0, 0.0});
  }

  /// Starts the rotor. The friction parameters are those at the start position, wherever the rotor goes.
  DahlFriction(const motion::PlantParameters& plant, const FrictionAlongRotor& friction,
               const motion::PlantStart& start, const motion::MotionTolerance& tolerance)
      : Bristle(bristle(plant, friction_at(friction, start.position)), plant.inertia, start, tolerance) {}
};

/// The LuGre law (Canudas de Wit, Olsson, Åström and Lischinsky, "A new model for control of systems with
/// friction", IEEE Trans. Automatic Control 40, 1995):
///
///   dz/dt = ω − σ0·|ω|·z/g(ω),   F = σ0·z + σ1·dz/dt + cs·ω,   with g of StribeckCurve.
class LuGreFriction : public Bristle {
 public:
  static constexpr std::string_view word = "lugre";
  static constexpr std::array<ContactField, 5> contact_parameters{
      &FrictionParameters::breakaway, &FrictionParameters::coulomb_ratio,
      &FrictionParameters::stribeck_velocity, &FrictionParameters::sigma0, &FrictionParameters::sigma1};
  static constexpr bool has_presliding_damping = false;
  static constexpr bool has_sliding_damping = true;

  static LinearContacts linear_contacts(const motion::PlantParameters& plant, const FrictionAlongRotor&,
                                        const FrictionParameters& contact) {
    return {{"at sigma0", contact.sigma0, contact.sigma1 + plant.sliding_damping}, sliding_contact(plant)};
  }
  static BristleParameters bristle(const motion::PlantParameters& plant, const FrictionParameters& contact) {
    return bristle_parameters(contact.sigma0, contact.sigma1, plant.sliding_damping, stribeck_curve(contact));
  }

  /// Starts the rotor. The friction parameters are those at the start position, wherever the rotor goes.
  LuGreFriction(const motion::PlantParameters& plant, const FrictionAlongRotor& friction,
                const motion::PlantStart& start, const motion::MotionTolerance& tolerance)
      : Bristle(bristle(plant, friction_at(friction, start.position)), plant.inertia, start, tolerance) {}
};

}  // namespace zerocount::friction
