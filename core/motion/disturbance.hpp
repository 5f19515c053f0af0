#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/motion/disturbance_formulas.hpp"
#include "core/numerics/power_series.hpp"

namespace zerocount::motion {

/// A torque, or a kinematic error, that varies along an angle: amplitude·sin(per_angle·θ + phase).
struct Ripple {
  double amplitude{0.0};  ///< N m; rad of a kinematic error
  double per_angle{0.0};  ///< rad/rad (rad/m on a linear axis)
  double phase{0.0};      ///< Phase at θ = 0, rad
};

/// A torque that varies in time: amplitude·sin(rate·t + phase).
struct Vibration {
  double amplitude{0.0};  ///< N m
  double rate{0.0};       ///< 2π·frequency, rad/s
  double phase{0.0};      ///< Phase at t = 0, rad
};

/// A disturbance of the rotor or of the load: d = torque + Σ ripple + Σ vibration.
struct Disturbance {
  double torque{0.0};  ///< N m
  std::vector<Ripple> ripple{};
  std::vector<Vibration> vibration{};
};

/// Whether d is not constant.
inline bool varies(const Disturbance& disturbance) {
  return !disturbance.ripple.empty() || !disturbance.vibration.empty();
}

/// Bound of the truncation error of a Taylor series of Σ vibration within `duration` (s), if the series ends
/// before `order` (Lagrange): Σ |amplitude|·(rate·duration)ᵒʳᵈᵉʳ/order!, N m.
double vibration_beyond(const Disturbance& disturbance, std::size_t order, double duration);

/// The varying part of a disturbance at an instant.
struct VaryingTorque {
  const Disturbance& of;
  double time;   ///< t, s
  double theta;  ///< θ, rad
};

/// Value of the varying torque, Σ ripple + Σ vibration, N m.
double value(const VaryingTorque& torque);

/// Rate of change of the varying torque, N m/s. @param omega ω, rad/s.
double rate(const VaryingTorque& torque, double omega);

/// Sum of the ripples at an angle, Σ amplitude·sin(per_angle·θ + phase).
double value(std::span<const Ripple> ripples, double theta);

/// Derivative of Σ amplitude·sin(per_angle·θ + phase) by θ.
double slope(std::span<const Ripple> ripples, double theta);

/// The Taylor series in time of ripples, given the series of ω = dθ/dt.
class RippleSeries {
 public:
  RippleSeries(std::span<const Ripple> ripples, double theta);

  /// Computes the coefficients k, given the coefficients of ω up to k − 1. Call with ascending k.
  void expand(const numerics::Series& omega, std::size_t k);
  /// `sum` plus coefficient k of Σ amplitude·s.
  double value(std::size_t k, double sum) const;
  /// Coefficient k of Σ amplitude·q·c.
  double slope(std::size_t k) const;

 private:
  struct Wave : WaveSeriesOf<numerics::Series> {
    double amplitude;
    double per_angle;
  };

  std::vector<Wave> waves_;
};

/// The Taylor series in time of the varying part of a disturbance, given the series of ω.
class DisturbanceSeries {
 public:
  explicit DisturbanceSeries(const VaryingTorque& torque);

  /// Computes coefficient k, N m/sᵏ, given the coefficients of ω up to k − 1. Call with ascending k.
  double expand(const numerics::Series& omega, std::size_t k);

 private:
  numerics::Series vibration_{};
  RippleSeries ripple_;
};

}  // namespace zerocount::motion
