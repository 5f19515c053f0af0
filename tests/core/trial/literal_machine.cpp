#include <cmath>
#include <cstdlib>
#include <numbers>

#include "core/random/random_numbers.hpp"
#include "tests/core/trial/literal_trial.hpp"

namespace zerocount::testing {
namespace {

using Real = long double;
using Samples = std::vector<trial::SampleRecord>;

constexpr Real turn = 2 * std::numbers::pi_v<Real>;

Real systematic_position(Real theta, Real counts, const loop::EncoderErrors& errors,
                         const trial::InitialConditions& start) {
  const Real resolution = turn / counts;
  const Real origin = static_cast<Real>(start.position) - errors.eccentricity_angle;
  const Real seen = theta + errors.eccentricity * (std::sin(origin + theta) - std::sin(origin));
  const Real x = seen / resolution + start.encoder_phase;
  const auto wave = [&](Real at) {
    return std::sin(turn * (std::floor(start.position / resolution) + at) / errors.interpolation_period);
  };
  return x + errors.interpolation * (wave(x) - wave(start.encoder_phase));
}

/// Binomially distributed number for a uniform number: the smallest number at which the distribution function
/// reaches it, with the terms summed one by one.
std::int64_t binomial_by_terms(std::int64_t n, Real probability, Real uniform) {
  Real term = std::pow(1 - probability, static_cast<Real>(n));
  Real reached = term;
  std::int64_t happened = 0;
  while (reached < uniform && happened < n) {
    term *=
        static_cast<Real>(n - happened) / static_cast<Real>(happened + 1) * probability / (1 - probability);
    reached += term;
    ++happened;
  }
  return happened;
}

std::vector<std::int64_t> counts_of(Real counts, const loop::EncoderErrors& errors,
                                    const random::RandomKey& noise, const random::RandomKey& missed,
                                    const trial::TrialParameters& p, const Samples& samples) {
  const random::TrialRandomness& random = p.randomness;
  std::vector<std::int64_t> rounded;
  std::vector<std::int64_t> shown;
  std::int64_t lost = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    Real x = systematic_position(samples[k].theta, counts, errors, p.initial);
    x += errors.noise * static_cast<Real>(random::standard_normal_noise(
                            random::random_bits_at({noise, random.stream}, random.trial, k)));
    rounded.push_back(static_cast<std::int64_t>(std::floor(x)));
    const std::int64_t passed = k == 0 ? 0 : rounded[k] - rounded[k - 1];
    const Real uniform =
        random::open_uniform(random::random_bits_at({missed, random.stream}, random.trial, k));
    const std::int64_t not_counted = binomial_by_terms(std::abs(passed), errors.missed, uniform);
    lost += passed > 0 ? not_counted : -not_counted;
    shown.push_back(rounded[k] - lost);
  }
  return shown;
}

/// Output torque of the converter for the code that was decided at sample k, N m.
Real converted(const trial::TrialParameters& p, const Samples& samples, std::size_t k) {
  const loop::DacParameters& dac = p.dac;
  const Real half_range = (std::ldexp(Real{1}, dac.bits) - 1) / 2;
  const Real from_middle = (static_cast<Real>(samples[k].code) + Real{0.5}) / half_range;
  const Real bow = dac.nonlinearity * (1 - from_middle * from_middle);
  const Real z = random::standard_normal_noise(
      random::random_bits_at({p.randomness.dac_noise, p.randomness.stream}, p.randomness.trial, k));
  return dac.resolution * (1 + Real{dac.gain_error}) * (static_cast<Real>(samples[k].code) + bow) +
         dac.offset + dac.noise * z;
}

}  // namespace

std::vector<std::int64_t> literal_fine_counts(const trial::TrialParameters& p, const Samples& samples) {
  return counts_of(p.encoder.fine, p.encoder.fine_errors, p.randomness.fine_noise, p.randomness.fine_missed,
                   p, samples);
}

std::vector<std::int64_t> literal_coarse_counts(const trial::TrialParameters& p, const Samples& samples) {
  return counts_of(p.encoder.coarse, p.encoder.coarse_errors, p.randomness.coarse_noise,
                   p.randomness.coarse_missed, p, samples);
}

std::vector<std::array<LiteralDrive, 2>> literal_drive(const trial::TrialParameters& p,
                                                       const Samples& samples) {
  const bool exact = !p.command.torque.levels.empty() && p.command.torque.through == trial::TorquePath::exact;
  const auto input = [&](std::size_t k, std::size_t late) -> Real {
    if (k < late) return 0;
    return exact ? Real{samples[k - late].torque} : converted(p, samples, k - late);
  };
  const auto whole = static_cast<std::size_t>(p.controller.delay);
  const Real before = p.controller.delay - static_cast<Real>(whole);  // of a sample, with the older torque
  std::vector<std::array<LiteralDrive, 2>> drive;
  Real output = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    std::array<LiteralDrive, 2> parts{{{input(k, whole + 1), 0, before}, {input(k, whole), 0, 1 - before}}};
    for (LiteralDrive& part : parts) {
      part.time /= p.controller.sample_rate;
      if (p.amplifier.bandwidth == 0 && part.time > 0) output = part.input;
      part.output = output;
      output += -std::expm1(-turn * p.amplifier.bandwidth * part.time) * (part.input - output);
    }
    drive.push_back(parts);
  }
  return drive;
}

}  // namespace zerocount::testing
