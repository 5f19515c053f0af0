#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/friction/linear_contact.hpp"
#include "core/friction/parameters.hpp"
#include "core/friction/presliding/creep.hpp"
#include "core/motion/parameters.hpp"
#include "core/motion/taylor_step.hpp"

namespace zerocount::friction {

/// Pointer to a member of FrictionParameters, which selects one friction parameter.
using ContactField = double FrictionParameters::*;

/// Manner in which a friction law passes from rest to sliding.
enum class Breakaway {
  never,    ///< The law has no contact that could break away.
  of_hook,  ///< The contact breaks away at one instant, when the end of its spring (hook) begins to slide;
            ///< breakaways() counts these instants.
  gradual   ///< Sliding sets in gradually; sliding() is evaluated at the sampling instants.
};

/// Requirements on a friction law between rotor and bearing (README.md). A law holds its own state and the
/// rotor's, and computes their motion. A law is either a SmoothMotion, which the plant advances from event to
/// event, or it has step(torque, duration), which advances the motion by at most `duration` (s), by
/// taylor_step or in closed form, and returns the time used.
template <class Law>
concept FrictionLaw = std::constructible_from<Law, const motion::PlantParameters&, const FrictionAlongRotor&,
                                              const motion::PlantStart&, const motion::MotionTolerance&> &&
                      (motion::SmoothMotion<Law> ||
                       requires(Law law, const motion::TorqueCourse& torque, double duration) {
                         { law.step(torque, duration) } -> std::same_as<double>;
                       }) &&
                      requires(Law law, const Law now) {
  { Law::word } -> std::convertible_to<std::string_view>;                             // of friction.model
  { Law::contact_parameters } -> std::convertible_to<std::span<const ContactField>>;  // that it uses
  { Law::has_presliding_motion } -> std::convertible_to<bool>;  // the contact is elastic
  { Law::has_presliding_damping } -> std::convertible_to<bool>;  // J·dω/dt = u − c·ω − … at some time
  { Law::has_sliding_damping } -> std::convertible_to<bool>;  // J·dω/dt = u − cs·ω − … at some time
  { Law::remembers_loading } -> std::convertible_to<bool>;    // slow torques before the start have an effect
  { Law::breakaway } -> std::convertible_to<Breakaway>;
  // Springs and dampers that approximate it. A law of one bristle also has bristle(plant, contact).
  {
    Law::linear_contacts(motion::PlantParameters{}, FrictionAlongRotor{}, FrictionParameters{})
    } -> std::same_as<LinearContacts>;
  { now.theta() } -> std::same_as<double>;  // rad
  { now.omega() } -> std::same_as<double>;  // rad/s
  { now.creep() } -> std::convertible_to<CreepState>;
  { now.sliding() } -> std::same_as<bool>;
  { now.depth() } -> std::same_as<std::int64_t>;       // of the stack of reversal points
  { now.deepest() } -> std::same_as<std::int64_t>;     // the largest since forget_deepest()
  { now.breakaways() } -> std::same_as<std::int64_t>;  // since the start
  law.forget_deepest();
};

/// Base of friction laws without creep and without a stack of reversal points: the corresponding functions
/// return zero.
struct WithoutCreepAndReversals {
  static CreepState creep() { return {}; }
  static std::int64_t depth() { return 0; }
  static std::int64_t deepest() { return 0; }
  static void forget_deepest() {}
};

struct BristleParameters;

/// Properties of a friction law that do not depend on its state.
struct LawTraits {
  std::string_view word;
  std::span<const ContactField> contact_parameters;
  bool has_presliding_motion;
  bool has_presliding_damping;
  bool has_sliding_damping;
  bool remembers_loading;
  Breakaway breakaway;
  LinearContacts (*linear_contacts)(const motion::PlantParameters&, const FrictionAlongRotor&,
                                    const FrictionParameters& contact);
  /// Function that gives the parameters of a bristle law (Dahl, LuGre); null for other laws.
  BristleParameters (*bristle)(const motion::PlantParameters&, const FrictionParameters& contact);
};

/// Whether the friction law uses this parameter of the contact.
constexpr bool uses(const LawTraits& law, ContactField field) {
  return std::find(law.contact_parameters.begin(), law.contact_parameters.end(), field) !=
         law.contact_parameters.end();
}

template <FrictionLaw Law>
constexpr LawTraits traits_of() {
  LawTraits traits{Law::word,
                   Law::contact_parameters,
                   Law::has_presliding_motion,
                   Law::has_presliding_damping,
                   Law::has_sliding_damping,
                   Law::remembers_loading,
                   Law::breakaway,
                   Law::linear_contacts,
                   nullptr};
  if constexpr (requires { &Law::bristle; }) traits.bristle = Law::bristle;
  return traits;
}

}  // namespace zerocount::friction
