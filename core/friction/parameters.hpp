#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/friction/friction_model.hpp"
#include "core/friction/profile.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::friction {

/// Parameters of the friction of one contact, constant from its formation at a place of the rotor until the
/// next slip (paper, QN2). The paper gives k1 and k1 + k2 (section 4); the other defaults are assumed. β is
/// inferred from the outcomes that the paper reports: in a loop without delay its five gains all behave as it
/// says only between about 7e4 and 1.4e5 /rad (study beta-from-outcomes).
struct FrictionParameters {
  double k1{110.0};                ///< Lowest tangent stiffness of the spring, N m/rad
  double k2{750.0};                ///< Highest tangent stiffness of the spring minus k1, N m/rad
  double beta{1.0e5};              ///< Rate at which a branch softens from k1 + k2 to k1, 1/rad
  double alpha{0.5};               ///< Rate α at which creep approaches its limit, 1/s
  double lambda{10.0};             ///< Hardening modulus λ: creep under the torque σ ends at the hardening
                                   ///< |σ|ⁿ/λ, (N m)ⁿ/rad
  double n{2.0};                   ///< Exponent of the torque in the creep law, dimensionless, at least 1
  double breakaway{0.3};           ///< Torque at which the contact breaks away and slides, N m
  double coulomb_ratio{0.8};       ///< Coulomb torque divided by breakaway torque, dimensionless, in (0, 1]
  double stribeck_velocity{0.01};  ///< Velocity over which sliding friction falls to the Coulomb level, rad/s
  double sigma0{860.0};  ///< Stiffness σ0 of the bristles (Dahl, LuGre), N m/rad; by default k1 + k2
  /// Damping σ1 of the bristles (LuGre), N m s/rad; by default the damping of the paper's contact
  double sigma1{0.2};
  double gms_attraction{30.0};  ///< Rate C at which a slipping element's torque goes to its level, N m/s
};

/// One element of the generalised Maxwell-slip friction model, a spring that sticks or slips.
struct GmsElement {
  double stiffness{0.0};  ///< Stiffness κ of the element, N m/rad
  /// Fraction η of the friction level that the element carries, dimensionless; all η sum to 1
  double weight{0.0};
};

/// Four Maxwell-slip elements whose virgin curve is near the virgin curve of the hysteretic spring with its
/// default parameters: one of stiffness k1, and three of stiffness k2/3 each, which slip at 1.1, 3.8 and 10
/// µrad.
std::vector<GmsElement> gms_like_the_spring();

/// A friction parameter that varies along the rotor's angle, with its profile.
struct ProfiledParameter {
  double FrictionParameters::*parameter{nullptr};
  std::shared_ptr<const Profile> profile;
};

/// A friction parameter that is drawn anew for every contact of a trial. Contact 0 exists at t = 0 and has
/// the value in FrictionAlongRotor::uniform. Contact k ≥ 1 forms when the sliding hook sticks for the k-th
/// time. The value depends only on the number of the contact, not on the course of the trial.
struct ContactParameter {
  double FrictionParameters::*parameter{nullptr};
  /// Function that returns the parameter's value in contact number `contact` (≥ 1), in the parameter's unit.
  std::function<double(std::uint64_t contact)> value;
};

/// The uniform random number in (0, 1) from which a friction parameter of contact number `contact` of trial
/// `trial` is drawn.
inline double contact_uniform(const random::RandomStream& stream, std::uint64_t trial,
                              std::uint64_t contact) {
  return random::open_uniform(random::random_bits_at(stream, trial, contact));
}

/// Friction parameters along the rotor: `uniform` everywhere, except the parameters that have a profile along
/// the angle or differ from contact to contact. A parameter is in at most one of the two lists.
struct FrictionAlongRotor {
  FrictionParameters uniform;
  std::vector<ProfiledParameter> profiled;
  FrictionModel model{FrictionModel::presliding};
  std::vector<ContactParameter> per_contact{};
  std::vector<GmsElement> gms_elements{};  ///< Elements of the friction model `gms`; empty:
                                           ///< gms_like_the_spring()
};

/// The elements of the friction model `gms`: the given ones or, if there are none, gms_like_the_spring().
inline std::vector<GmsElement> gms_elements_of(const FrictionAlongRotor& friction) {
  return friction.gms_elements.empty() ? gms_like_the_spring() : friction.gms_elements;
}

/// The friction parameters of a contact that forms at the rotor angle `angle` (rad, absolute, from the
/// profiles' origin).
/// @param contact_number number of the contact in the trial, 0 for the contact at t = 0.
inline FrictionParameters friction_at(const FrictionAlongRotor& friction, double angle,
                                      std::int64_t contact_number = 0) {
  FrictionParameters contact = friction.uniform;
  for (const ContactParameter& entry : friction.per_contact) {
    if (contact_number == 0) continue;
    contact.*entry.parameter = entry.value(static_cast<std::uint64_t>(contact_number));
  }
  for (const ProfiledParameter& entry : friction.profiled) {
    contact.*entry.parameter = value_at(*entry.profile, angle);
  }
  if (!has_creep(friction.model)) contact.alpha = 0.0;
  return contact;
}

}  // namespace zerocount::friction
