#include "core/motion/disturbance.hpp"

#include <cmath>

#include "core/numerics/elementary_functions.hpp"

namespace zerocount::motion {
namespace {

double angle(const Ripple& ripple, double theta) {
  return ripple.per_angle * theta + ripple.phase;
}
double angle(const Vibration& line, double time) {
  return line.rate * time + line.phase;
}

}  // namespace

double value(std::span<const Ripple> ripples, double theta) {
  double sum = 0.0;
  for (const Ripple& ripple : ripples) sum += ripple.amplitude * numerics::sin(angle(ripple, theta));
  return sum;
}

double slope(std::span<const Ripple> ripples, double theta) {
  double sum = 0.0;
  for (const Ripple& ripple : ripples)
    sum += ripple.amplitude * ripple.per_angle * numerics::cos(angle(ripple, theta));
  return sum;
}

double value(const VaryingTorque& torque) {
  double sum = value(torque.of.ripple, torque.theta);
  for (const Vibration& line : torque.of.vibration)
    sum += line.amplitude * numerics::sin(angle(line, torque.time));
  return sum;
}

double rate(const VaryingTorque& torque, double omega) {
  double sum = 0.0;
  for (const Ripple& ripple : torque.of.ripple)
    sum += ripple.amplitude * ripple.per_angle * omega * numerics::cos(angle(ripple, torque.theta));
  for (const Vibration& line : torque.of.vibration)
    sum += line.amplitude * line.rate * numerics::cos(angle(line, torque.time));
  return sum;
}

double vibration_beyond(const Disturbance& disturbance, std::size_t order, double duration) {
  double sum = 0.0;
  for (const Vibration& line : disturbance.vibration) {
    double term = std::abs(line.amplitude);
    for (std::size_t k = 1; k <= order; ++k) term *= std::abs(line.rate) * duration / static_cast<double>(k);
    sum += term;
  }
  return sum;
}

RippleSeries::RippleSeries(std::span<const Ripple> ripples, double theta) {
  waves_.reserve(ripples.size());
  for (const Ripple& ripple : ripples) {
    Wave wave{ripple.amplitude, ripple.per_angle, {}, {}};
    wave.sine[0] = numerics::sin(angle(ripple, theta));
    wave.cosine[0] = numerics::cos(angle(ripple, theta));
    waves_.push_back(wave);
  }
}

void RippleSeries::expand(const numerics::Series& omega, std::size_t k) {
  if (k == 0) return;
  for (Wave& wave : waves_) {
    double sine = 0.0;
    double cosine = 0.0;
    for (std::size_t j = 0; j < k; ++j) {
      sine += omega[j] * wave.cosine[k - 1 - j];
      cosine -= omega[j] * wave.sine[k - 1 - j];
    }
    wave.sine[k] = wave.per_angle * sine * numerics::reciprocal[k];
    wave.cosine[k] = wave.per_angle * cosine * numerics::reciprocal[k];
  }
}

double RippleSeries::value(std::size_t k, double sum) const {
  for (const Wave& wave : waves_) sum += wave.amplitude * wave.sine[k];
  return sum;
}

double RippleSeries::slope(std::size_t k) const {
  double sum = 0.0;
  for (const Wave& wave : waves_) sum += wave.amplitude * wave.per_angle * wave.cosine[k];
  return sum;
}

DisturbanceSeries::DisturbanceSeries(const VaryingTorque& torque) : ripple_(torque.of.ripple, torque.theta) {
  for (const Vibration& line : torque.of.vibration) {
    double sine = line.amplitude * numerics::sin(angle(line, torque.time));
    double cosine = line.amplitude * numerics::cos(angle(line, torque.time));
    vibration_[0] += sine;
    for (std::size_t k = 1; k <= numerics::series_order; ++k) {
      const double step = line.rate * numerics::reciprocal[k];
      const double next = step * cosine;  // the derivatives of sin are cos, −sin, …
      cosine = -step * sine;
      sine = next;
      vibration_[k] += sine;
    }
  }
}

double DisturbanceSeries::expand(const numerics::Series& omega, std::size_t k) {
  ripple_.expand(omega, k);
  return ripple_.value(k, vibration_[k]);
}

}  // namespace zerocount::motion
