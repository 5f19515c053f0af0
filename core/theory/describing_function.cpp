#include "core/theory/describing_function.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/friction/bristles/bristle.hpp"

namespace zerocount::theory {
namespace {

using Complex = std::complex<double>;

constexpr int steps = 200;  // of half a period
constexpr double step = std::numbers::pi / steps;

/// Sines and cosines of Ωt, which the steps of all amplitudes and frequencies share.
struct HalfPeriod {
  std::array<double, steps> sine, cosine;  ///< in the middle of each step, from −π/2, where θ = −A, to π/2
  std::array<double, steps + 1> ends;      ///< sine at the ends of the steps
};

HalfPeriod new_half_period() {
  HalfPeriod half;
  for (int i = 0; i <= steps; ++i) {
    const auto index = static_cast<std::size_t>(i);
    half.ends[index] = std::sin(i * step - 0.5 * std::numbers::pi);
    if (i == steps) break;
    const double phase = (i + 0.5) * step - 0.5 * std::numbers::pi;
    half.sine[index] = std::sin(phase);
    half.cosine[index] = std::cos(phase);
  }
  return half;
}

const HalfPeriod& half_period() {
  static const HalfPeriod half = new_half_period();
  return half;
}

/// The part of a relay with the level g(ω), in phase with ω.
double relay_damping(const friction::StribeckCurve& curve, double amplitude, double frequency) {
  double sum = 0.0;
  for (const double cosine : half_period().cosine)
    sum += friction::level_at(curve, amplitude * frequency * cosine) * cosine;
  return 2.0 / std::numbers::pi * sum * step / amplitude;
}

/// One step of dz/dθ = 1 − σ0·z/g, θ growing: z ← keep·z + gain.
struct BristleStep {
  double keep;
  double gain;
};

BristleStep bristle_step(const friction::StribeckCurve& curve, double stiffness, double travel,
                         double omega) {
  const double length = friction::level_at(curve, omega) / stiffness;
  const double keep = std::exp(-travel / length);
  return {keep, length * (1.0 - keep)};
}

/// The fundamental of z over that of θ. The half period −π/2 … π/2 takes z from z₀ to −z₀, the other one
/// back.
Complex bristle_ratio(const friction::StribeckCurve& curve, double stiffness, double amplitude,
                      double frequency) {
  const HalfPeriod& half = half_period();
  std::array<BristleStep, steps> path;
  double keep = 1.0;
  double gain = 0.0;
  for (std::size_t i = 0; i < steps; ++i) {
    path[i] = bristle_step(curve, stiffness, amplitude * (half.ends[i + 1] - half.ends[i]),
                           amplitude * frequency * half.cosine[i]);
    keep *= path[i].keep;
    gain = path[i].keep * gain + path[i].gain;
  }
  double z = -gain / (1.0 + keep);
  Complex sum = 0.0;
  for (std::size_t i = 0; i < steps; ++i) {
    const double next = path[i].keep * z + path[i].gain;
    sum += 0.5 * (z + next) * Complex(half.sine[i], half.cosine[i]);
    z = next;
  }
  return 2.0 / std::numbers::pi * sum * step / amplitude;
}

}  // namespace

bool has_describing_function(friction::FrictionModel model) {
  const friction::LawTraits& law = friction::traits_of(model);
  return friction::is_relay(law) || law.bristle != nullptr;
}

double describing_function(const loop::ErrorDeadband& deadband, double amplitude) {
  if (deadband.band <= 0.0) return 1.0;
  if (amplitude <= deadband.band) return 0.0;
  const double sine = deadband.band / amplitude;
  const double overlap = sine * std::sqrt(1.0 - sine * sine);
  const double sign = deadband.form == loop::DeadbandForm::subtract ? 1.0 : -1.0;
  return 1.0 - 2.0 / std::numbers::pi * (std::asin(sine) + sign * overlap);
}

Complex describing_function(friction::FrictionModel model, const friction::FrictionParameters& contact,
                            const motion::PlantParameters& plant, double amplitude, double frequency) {
  const friction::LawTraits& law = friction::traits_of(model);
  const Complex rate(0.0, frequency);
  if (law.bristle == nullptr) {
    const friction::StribeckCurve curve = friction::stribeck_curve(contact);
    return rate * plant.sliding_damping + Complex(0.0, relay_damping(curve, amplitude, frequency));
  }
  const friction::BristleParameters bristle = law.bristle(plant, contact);
  const Complex ratio = bristle_ratio(bristle.level, bristle.stiffness, amplitude, frequency);
  return (bristle.stiffness + rate * bristle.bristle_damping) * ratio + rate * bristle.damping;
}

}  // namespace zerocount::theory
