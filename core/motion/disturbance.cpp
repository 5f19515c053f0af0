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
    Wave wave{{}, ripple.amplitude, ripple.per_angle};
    wave.sine[0] = numerics::sin(angle(ripple, theta));
    wave.cosine[0] = numerics::cos(angle(ripple, theta));
    waves_.push_back(wave);
  }
}

void RippleSeries::expand(const numerics::Series& omega, std::size_t k) {
  if (k == 0) return;
  for (Wave& wave : waves_) wave.expand(wave.per_angle, omega.data(), k);
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
    const double sine = line.amplitude * numerics::sin(angle(line, torque.time));
    const double cosine = line.amplitude * numerics::cos(angle(line, torque.time));
    add_line(line.rate, sine, cosine, numerics::series_order, vibration_);
  }
}

double DisturbanceSeries::expand(const numerics::Series& omega, std::size_t k) {
  ripple_.expand(omega, k);
  return ripple_.value(k, vibration_[k]);
}

}  // namespace zerocount::motion
