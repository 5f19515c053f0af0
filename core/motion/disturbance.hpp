#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/motion/disturbance_formulas.hpp"
#include "core/numerics/power_series.hpp"

namespace zerocount::motion {

/// A torque, or a kinematic error of the coupling, that varies periodically along an angle:
/// amplitude·sin(per_angle·θ + phase).
struct Ripple {
  double amplitude{0.0};  ///< Amplitude, N m, or rad for a kinematic error
  double per_angle{0.0};  ///< Phase of the ripple per angle, rad/rad (rad/m on a linear axis)
  double phase{0.0};      ///< Phase at θ = 0, rad
};

/// A torque that varies sinusoidally in time: amplitude·sin(rate·t + phase).
struct Vibration {
  double amplitude{0.0};  ///< Amplitude, N m
  double rate{0.0};       ///< Angular frequency 2π·frequency, rad/s
  double phase{0.0};      ///< Phase at t = 0, rad
};

/// A disturbance torque d on the rotor or on the load: d = torque + Σ ripple + Σ vibration.
struct Disturbance {
  double torque{0.0};  ///< Constant part of the disturbance, N m
  std::vector<Ripple> ripple{};
  std::vector<Vibration> vibration{};
};

/// Whether the disturbance has ripples or vibrations, so that it is not constant.
inline bool varies(const Disturbance& disturbance) {
  return !disturbance.ripple.empty() || !disturbance.vibration.empty();
}

/// Upper bound of the truncation error of a Taylor series of Σ vibration within `duration` (s), if the series
/// ends before the power `order` (Lagrange): Σ |amplitude|·(rate·duration)ᵒʳᵈᵉʳ/order!, N m.
double vibration_beyond(const Disturbance& disturbance, std::size_t order, double duration);

/// The varying part of a disturbance (ripples and vibrations), with the time and angle at which it is to be
/// evaluated.
struct VaryingTorque {
  const Disturbance& of;
  double time;   ///< Time t, s
  double theta;  ///< Angle θ of the mass on which the disturbance acts, rad
};

/// Value of the varying torque, Σ ripple + Σ vibration, N m.
double value(const VaryingTorque& torque);

/// Rate of change of the varying torque along the motion, N m/s.
/// @param omega velocity ω of the mass, rad/s.
double rate(const VaryingTorque& torque, double omega);

/// Sum of the ripples at the angle θ (rad), Σ amplitude·sin(per_angle·θ + phase), in the unit of their
/// amplitudes.
double value(std::span<const Ripple> ripples, double theta);

/// Derivative by θ of the sum of the ripples, Σ amplitude·sin(per_angle·θ + phase), at the angle θ (rad).
double slope(std::span<const Ripple> ripples, double theta);

/// The Taylor series in time of ripples along a motion, given the series of ω = dθ/dt.
class RippleSeries {
 public:
  RippleSeries(std::span<const Ripple> ripples, double theta);

  /// Computes coefficient k of each ripple's sine and cosine, given the coefficients of ω up to k − 1. Call
  /// with ascending k.
  void expand(const numerics::Series& omega, std::size_t k);
  /// `sum` plus coefficient k of the sum of the ripples, Σ amplitude·sin(q·θ + φ).
  double value(std::size_t k, double sum) const;
  /// Coefficient k of the derivative of the ripples' sum by θ, Σ amplitude·q·cos(q·θ + φ), with q =
  /// per_angle.
  double slope(std::size_t k) const;

 private:
  struct Wave : WaveSeriesOf<numerics::Series> {
    double amplitude;
    double per_angle;
  };

  std::vector<Wave> waves_;
};

/// The Taylor series in time of the varying part of a disturbance (ripples and vibrations), given the series
/// of the velocity ω.
class DisturbanceSeries {
 public:
  explicit DisturbanceSeries(const VaryingTorque& torque);

  /// Computes coefficient k of the varying torque, N m/sᵏ, given the coefficients of ω up to k − 1. Call with
  /// ascending k.
  double expand(const numerics::Series& omega, std::size_t k);

 private:
  numerics::Series vibration_{};
  RippleSeries ripple_;
};

}  // namespace zerocount::motion
