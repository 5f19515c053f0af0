#include "core/loop/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "core/numerics/elementary_functions.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::loop {
namespace {

/// Largest absolute count of an encoder with errors: up to it a double represents all whole numbers exactly.
/// Only unrealistic encoder errors reach it.
constexpr double farthest_count = 0x1p52;

}  // namespace

bool has_errors(const EncoderErrors& errors) {
  [[maybe_unused]] const auto& [eccentricity, eccentricity_angle, interpolation, interpolation_period, noise,
                                missed, bandwidth] = errors;
  return eccentricity != 0.0 || interpolation != 0.0 || noise != 0.0 || missed != 0.0;
}

NoiseConstants<double> noise_constants(const EncoderErrors& errors, double sample_time) {
  const double a = numerics::exp(-2.0 * std::numbers::pi * errors.noise_bandwidth * sample_time);
  return {errors.noise, a, std::sqrt(1.0 - a * a)};
}

bool counts_agree(const Encoder& fine, const Encoder& coarse, const EncoderReading& reading) {
  const double ratio = fine.resolution / coarse.resolution;
  const double from = (static_cast<double>(reading.fine) - fine.phase) * ratio + coarse.phase;
  return counts_may_coincide(from, ratio, static_cast<double>(reading.coarse));
}

ImperfectEncoder::ImperfectEncoder(const Encoder& encoder, const EncoderErrors& errors, double position,
                                   double sample_time, std::uint64_t trial, const random::RandomStream& noise,
                                   const random::RandomStream& missed)
    : encoder_(encoder),
      errors_(errors),
      position_(position),
      trial_(trial),
      noise_(noise),
      missed_(missed),
      start_eccentricity_(numerics::sin(position - errors.eccentricity_angle)),
      start_count_(std::floor(position / encoder.resolution)),
      constants_(noise_constants(errors, sample_time)) {
  if (errors.interpolation != 0.0) start_interpolation_ = interpolation_error(encoder.phase);
}

double ImperfectEncoder::interpolation_error(double x) const {
  // The remainder is exact, and keeps the sine's argument small.
  const double periods =
      std::remainder(start_count_ + x, errors_.interpolation_period) / errors_.interpolation_period;
  return errors_.interpolation * numerics::sin(2.0 * std::numbers::pi * periods);
}

std::int64_t ImperfectEncoder::read(std::int64_t k, double theta) {
  if (errors_.eccentricity != 0.0) {
    const double sine = numerics::sin(position_ + theta - errors_.eccentricity_angle);
    theta += errors_.eccentricity * (sine - start_eccentricity_);
  }
  double x = theta / encoder_.resolution + encoder_.phase;
  if (errors_.interpolation != 0.0) x += interpolation_error(x) - start_interpolation_;
  if (errors_.noise != 0.0) x += next_noise(k);
  // fmin and fmax pass over what is not a number.
  const auto raw =
      static_cast<std::int64_t>(std::floor(std::fmin(std::fmax(x, -farthest_count), farthest_count)));
  if (errors_.missed != 0.0) miss_counts(k, raw);
  return raw - lost_;
}

double ImperfectEncoder::next_noise(std::int64_t k) {
  const double drawn =
      random::standard_normal_noise(random::random_bits_at(noise_, trial_, static_cast<std::uint64_t>(k)));
  noise_state_ = loop::next_noise(constants_, noise_state_, k == 0, drawn);
  return constants_.deviation * noise_state_;
}

void ImperfectEncoder::miss_counts(std::int64_t k, std::int64_t raw) {
  const std::int64_t passed = first_ ? 0 : raw - last_raw_;
  first_ = false;
  last_raw_ = raw;
  if (passed == 0) return;
  const std::int64_t missed =
      random::binomial_number(std::abs(passed), errors_.missed,
                              random::random_bits_at(missed_, trial_, static_cast<std::uint64_t>(k)));
  lost_ += passed > 0 ? missed : -missed;
}

Measurement::Measurement(const EncoderParameters& encoders, double phase, double position,
                         const random::TrialRandomness& randomness, double sample_time, double other_phase)
    : fine_(fine_encoder(encoders, phase)),
      coarse_(coarse_encoder(encoders, phase)),
      finest_(std::min({fine_.resolution, coarse_.resolution, other_resolution(encoders)})),
      fine_per_coarse_(loop::fine_per_coarse(encoders)),
      ideal_(!has_errors(encoders.fine_errors) && !has_errors(encoders.coarse_errors)),
      imperfect_fine_(fine_, encoders.fine_errors, position, sample_time, randomness.trial,
                      {randomness.fine_noise, randomness.stream},
                      {randomness.fine_missed, randomness.stream}),
      imperfect_coarse_(coarse_, encoders.coarse_errors, position, sample_time, randomness.trial,
                        {randomness.coarse_noise, randomness.stream},
                        {randomness.coarse_missed, randomness.stream}) {
  if (has_other(encoders))
    imperfect_other_.emplace(Encoder{other_resolution(encoders), other_phase}, encoders.other.errors,
                             position, sample_time, randomness.trial,
                             random::RandomStream{randomness.other_noise, randomness.stream},
                             random::RandomStream{randomness.other_missed, randomness.stream});
}

EncoderReading Measurement::read_with_errors(std::int64_t k, double theta) {
  const EncoderReading reading{imperfect_fine_.read(k, theta), imperfect_coarse_.read(k, theta)};
  const bool possible =
      counts_agree(fine_, coarse_, reading) ||
      (reading.fine == read_count(fine_, theta) && reading.coarse == read_count(coarse_, theta));
  if (!possible && !imperfect_other_) ++disagreements_;
  return reading;
}

}  // namespace zerocount::loop
