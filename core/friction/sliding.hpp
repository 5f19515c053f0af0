#pragma once

#include <cmath>

#include "core/friction/parameters.hpp"
#include "core/motion/taylor_step.hpp"
#include "core/motion/torque_course.hpp"

namespace zerocount::friction {

/// Taylor series in time of the sliding motion.
struct SlidingSeries {
  numerics::Series position{};   ///< θ, rad
  numerics::Series omega{};      ///< ω, rad/s
  numerics::Series exponent{};   ///< −(ω/ωs)², dimensionless
  numerics::Series slope{};      ///< of the exponent in time, 1/s
  numerics::Series lightness{};  ///< exp(−(ω/ωs)²)
  double coulomb;                ///< d·Fc, N m
  double stribeck;               ///< d·(Fs − Fc), N m
  double per_velocity_squared;   ///< 1/ωs², s²/rad²
};

/// The motion while the hook slides (paper, eq. 3, with Stribeck friction):
///
///   J·dω/dt = u − cs·ω − d·(Fc + (Fs − Fc)·exp(−(ω/ωs)²)),   dθ/dt = ω,
///
/// Fs = breakaway, Fc = coulomb_ratio·Fs, ωs = stribeck_velocity. It ends where ω comes to 0.
struct Slide {
  using Expansion = SlidingSeries;
  enum class Event { none, velocity_zero };

  const FrictionParameters& contact;
  double damping;    ///< cs, N m s/rad
  double theta;      ///< rad
  double omega;      ///< rad/s
  double direction;  ///< d, −1 or 1

  SlidingSeries start() const;
  double expand(SlidingSeries& s, std::size_t k, double torque) const {
    const double exponent = -s.per_velocity_squared * numerics::square_coefficient(s.omega.data(), k);
    s.exponent[k] = exponent;
    double lightness = 0.0;
    if (k > 0) {
      s.slope[k - 1] = static_cast<double>(k) * exponent;
      lightness = numerics::exponential_coefficient(s.slope.data(), s.lightness.data(), k);
    } else {
      lightness = std::exp(exponent);
    }
    s.lightness[k] = lightness;
    s.position[k + 1] = s.omega[k] * numerics::reciprocal[k + 1];
    const double driving = k == 0 ? torque - s.coulomb : torque;
    return driving - damping * s.omega[k] - s.stribeck * lightness;
  }
  static motion::NextEvent<Event> first_event(const SlidingSeries& series, double step);
  void go_to(const SlidingSeries& series, const motion::NextEvent<Event>& next);
};

/// Whether the slide can leave ω = 0 in its direction under the torque.
bool leaves_rest(const Slide& slide, double inertia, const motion::TorqueCourse& torque);

struct SlideStep {
  double time;  ///< used, s
  bool ended;   ///< ω has come to 0, or cannot leave it
};

/// Takes the slide on by a Taylor step, at most by `duration` (s).
SlideStep slide_step(Slide& slide, double inertia, const motion::TorqueCourse& torque, double tolerance,
                     double duration);

}  // namespace zerocount::friction
