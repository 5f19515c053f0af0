#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/friction/bristles/gms_formulas.hpp"
#include "core/friction/law.hpp"
#include "core/friction/sliding/sliding.hpp"

namespace zerocount::friction {

using GmsState = GmsStateOf<double>;
using GmsSeries = GmsSeriesOf<numerics::Series>;

/// The motion of a rotor on elements that stick or slip, with a constant sign s of ω:
///
///   J·dω/dt = u − ΣFi − cs·ω,   dθ/dt = ω,
///   sticking: dFi/dt = κi·ω, until s·Fi = ηi·g(ω);   slipping: dFi/dt = C·(s·ηi − Fi/g(ω)).
///
/// It ends when an element begins to slip, or at ω = 0.
///
/// All slipping elements relax at the same rate. With H = Σηi over them, their torque S = ΣFi obeys dS/dt =
/// C·(s·H − S/g), and with dE/dt = −C·E/g, E(0) = 1, each is Fi = ηi·S/H + (Fi(0) − ηi·S(0)/H)·E. The number
/// of series therefore does not grow with the number of elements. Where g is constant, slipping elements stay
/// at its level, whatever C is.
struct GmsMotion {
  using Expansion = GmsSeries;
  enum class Event { none, slip, velocity_zero };

  std::span<GmsState> elements;
  GmsConstants<double> law;  ///< Constants of the law, with acting_attraction() as the attraction.
  double direction;          ///< Direction s of the motion, −1 or 1
  double& theta;             ///< Rotor angle θ, rad
  double& omega;             ///< Rotor velocity ω, rad/s
  GmsSums<double> sums;      ///< Sums over the elements at the start of the step.

  GmsSeries start() const;
  double expand(GmsSeries& s, std::size_t k, double torque) const {
    return gms_coefficient(law, sums, direction, s, k, torque);
  }
  /// Longest step within the tolerance, s. It bounds the errors of two torques by the tolerance (rad) times
  /// the largest stiffness: the torques of slipping elements, and the level that sticking elements may reach.
  double step_of_state(const GmsSeries& series, double tolerance, double duration) const;
  void complete(GmsSeries& s) const { s.expand_level(law.level, s.omega.data(), numerics::series_order); }
  motion::NextEvent<Event> first_event(const GmsSeries& series, double step) const;
  void go_to(const GmsSeries& series, const motion::NextEvent<Event>& next);

 private:
  bool may_slip(const GmsSeries& series, double step) const;
  numerics::Series margin_of(const GmsState& state, const GmsSeries& series) const;
};

/// The generalised Maxwell-slip model (Al-Bender, Lampaert and Swevers, "The generalized Maxwell-slip model:
/// a novel model for friction simulation and compensation", IEEE Trans. Automatic Control 50, 2005), by
/// GmsMotion. An element slips where its torque *in the direction of motion* reaches ηi·g(ω). After a
/// reversal g may fall below the torque that the element still has; the element then unloads as a spring. If
/// it slipped at once, its torque would drive the motion.
///
/// Rest rule. While all elements stick, a small oscillation is that of their springs. Where u is constant, no
/// element slips and A < ε = MotionTolerance::rest with
///
///   A = |u − ΣFi|/K + |ω|·√(J/K),
///
/// K = Σκi of the elements that no travel of ε can bring to slip, the rotor is at rest, with ω = 0 and u −
/// ΣFi carried by those elements, until the torque changes.
class GmsFriction : public WithoutCreepAndReversals {
 public:
  static constexpr std::string_view word = "gms";
  static constexpr std::array<ContactField, 4> contact_parameters{
      &FrictionParameters::breakaway, &FrictionParameters::coulomb_ratio,
      &FrictionParameters::stribeck_velocity, &FrictionParameters::gms_attraction};
  static constexpr bool has_presliding_motion = true;
  static constexpr bool has_presliding_damping = false;
  static constexpr bool has_sliding_damping = true;
  static constexpr bool remembers_loading = true;
  static constexpr Breakaway breakaway = Breakaway::gradual;
  static LinearContacts linear_contacts(const motion::PlantParameters& plant,
                                        const FrictionAlongRotor& friction, const FrictionParameters&);

  /// Starts the rotor. The friction parameters are those at the start position, wherever the rotor goes. With
  /// `start.sliding` and a velocity, all elements slip steadily at first, Fi = sgn(ω)·ηi·g(ω).
  GmsFriction(const motion::PlantParameters& plant, const FrictionAlongRotor& friction,
              const motion::PlantStart& start, const motion::MotionTolerance& tolerance);

  double step(const motion::TorqueCourse& torque, double duration);

  double theta() const { return theta_; }
  double omega() const { return omega_; }
  /// Whether the contact slides: all of its elements slip.
  bool sliding() const;
  static std::int64_t breakaways() { return 0; }
  std::span<const GmsState> elements() const { return elements_; }

 private:
  double torque() const;
  double softest() const;
  void load_slowly(double torque);

  motion::PlantParameters plant_;
  motion::MotionTolerance tolerance_;
  GmsConstants<double> constants_;
  std::vector<GmsState> elements_;
  double theta_{0.0};
  double omega_;
  std::optional<double> rest_torque_;  // under which the rotor is at rest, N m
};

}  // namespace zerocount::friction
