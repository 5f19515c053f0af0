#pragma once

#include "core/friction/parameters.hpp"
#include "core/friction/sliding/slide_formulas.hpp"
#include "core/motion/taylor_step.hpp"
#include "core/motion/torque_course.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::friction {

using StribeckCurve = StribeckCurveOf<double>;

/// Stribeck curve of a contact: Fs = breakaway, Fc = coulomb_ratio·Fs, ωs = stribeck_velocity.
inline StribeckCurve stribeck_curve(const FrictionParameters& contact) {
  const double coulomb = contact.coulomb_ratio * contact.breakaway;
  return {coulomb, contact.breakaway - coulomb,
          1.0 / (contact.stribeck_velocity * contact.stribeck_velocity)};
}

/// Level of sliding friction g(ω) at the velocity ω = `omega` (rad/s), N m.
template <class Number>
Number level_at(const StribeckCurveOf<Number>& curve, Number omega) {
  using numerics::exp;
  return curve.coulomb + curve.excess * exp(-curve.per_velocity_squared * omega * omega);
}

/// Value of exp(−(ω/ωs)²) at the velocity ω = `omega` (rad/s), which is coefficient 0 of
/// StribeckSeriesOf::decay.
inline double decay_at(const StribeckCurve& curve, double omega) {
  return numerics::exp(-curve.per_velocity_squared * (omega * omega));
}

/// Torque u − cs·ω − d·g(ω) that accelerates a rotor whose friction contact slides in the direction d = ±1, N
/// m.
/// @param torque u, N m.
/// @param damping cs, N m s/rad.
/// @param curve Stribeck curve g, not multiplied by d.
template <class Number>
Number sliding_torque(const Number& torque, const Number& damping, const StribeckCurveOf<Number>& curve,
                      double direction, const Number& omega) {
  return torque - damping * omega - direction * level_at(curve, omega);
}

/// Taylor series in time of the motion of a rotor whose friction contact slides, in double.
struct SlidingSeries : SlideSeriesOf<numerics::Series> {
  SlideConstants<double> constants;
};

/// The motion of a rotor while its friction contact slides (paper, eq. 3, with Stribeck friction):
///
///   J·dω/dt = u − cs·ω − d·g(ω),   dθ/dt = ω,
///
/// with g of StribeckCurve and d the direction of the slide. It ends at ω = 0.
struct Slide {
  using Expansion = SlidingSeries;
  enum class Event { none, velocity_zero };

  const FrictionParameters& contact;
  double damping;    ///< Viscous damping cs, N m s/rad
  double theta;      ///< Rotor angle θ, rad
  double omega;      ///< Rotor velocity ω, rad/s
  double direction;  ///< Direction d of the slide, −1 or 1
  /// Whether the slide starts at ω = 0 because u has just reached d·g(0). The rounded value of u then does
  /// not decide whether the slide begins.
  bool at_level{false};

  SlidingSeries start() const;
  double expand(SlidingSeries& s, std::size_t k, double torque) const {
    const double accelerating = slide_coefficient<false>(s.constants, s, k, torque);
    return at_level && k == 0 ? 0.0 : accelerating;
  }
  static motion::NextEvent<Event> first_event(const SlidingSeries& series, double step);
  void go_to(const SlidingSeries& series, const motion::NextEvent<Event>& next);
};

/// Whether the slide can leave ω = 0 in its direction under the torque.
/// @param inertia J, kg m².
bool leaves_rest(const Slide& slide, double inertia, const motion::TorqueCourse& torque);

struct SlideStep {
  double time;  ///< Time that the step took, s
  bool ended;   ///< Whether ω has come to 0, or cannot leave it
};

/// Advances the slide by one Taylor step of at most `duration` (s).
/// @param inertia J, kg m².
/// @param tolerance truncation error of θ allowed per `duration`, rad.
SlideStep slide_step(Slide& slide, double inertia, const motion::TorqueCourse& torque, double tolerance,
                     double duration);

}  // namespace zerocount::friction
