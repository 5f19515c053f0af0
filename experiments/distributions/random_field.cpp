#include "experiments/distributions/random_field.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::distributions {
namespace {

constexpr double neglected_variance = 1e-12;

double standard_normal(const random::RandomKey& key, std::size_t harmonic, std::uint32_t rotor,
                       random::Draw draw) {
  const std::uint64_t index = harmonic + (std::uint64_t{rotor} << 32);
  return random::standard_normal(random::random_bits({.key = key}, index, draw));
}

}  // namespace

std::vector<double> field_spectrum(double correlation_length) {
  // The terms with m > M sum to less than ∫_M^∞ 2·exp(−(mℓ/2)²) dm = (2√π/ℓ)·erfc(Mℓ/2), and all terms to
  // at least max(1, 2√π/ℓ).
  const double whole = std::max(1.0, 2.0 * std::sqrt(std::numbers::pi) / correlation_length);
  const double tail = neglected_variance * whole * correlation_length / (2.0 * std::sqrt(std::numbers::pi));
  const double last = -std::numbers::sqrt2 / correlation_length * numerics::normal_quantile(0.5 * tail);
  std::vector<double> spectrum{1.0};
  for (double m = 1.0; m <= std::ceil(last); m += 1.0) {
    spectrum.push_back(2.0 * numerics::exp_of_draws(-0.25 * m * m * correlation_length * correlation_length));
  }
  const double sum = std::accumulate(spectrum.rbegin(), spectrum.rend(), 0.0);
  for (double& variance : spectrum) variance /= sum;
  return spectrum;
}

std::vector<double> field_amplitudes(const ProfileDescription& description) {
  std::vector<double> amplitudes =
      field_spectrum(description.correlation_length * (2.0 * std::numbers::pi / description.period));
  for (double& amplitude : amplitudes) amplitude = std::sqrt(amplitude);
  return amplitudes;
}

friction::Profile realise_profile(const ProfileDescription& description, std::span<const double> amplitudes,
                                  const random::RandomKey& key, std::uint32_t rotor) {
  friction::Profile profile;
  profile.marginal = description.marginal;
  profile.period = description.period;
  if (description.marginal == friction::Marginal::lognormal) {
    const double variance = numerics::log1p(description.cv * description.cv);
    profile.location = numerics::log_of_draws(description.mean) - 0.5 * variance;
    profile.scale = std::sqrt(variance);
  } else {
    profile.location = description.mean;
    profile.scale = description.mean * description.cv;
  }
  profile.cosine.reserve(amplitudes.size());
  profile.sine.reserve(amplitudes.size());
  for (std::size_t m = 0; m < amplitudes.size(); ++m) {
    profile.cosine.push_back(amplitudes[m] * standard_normal(key, m, rotor, random::Draw::profile_cosine));
    profile.sine.push_back(
        m == 0 ? 0.0 : amplitudes[m] * standard_normal(key, m, rotor, random::Draw::profile_sine));
  }
  return profile;
}

numerics::Interval limits(const friction::Profile& profile) {
  double largest = 0.0;
  for (std::size_t m = 0; m < profile.cosine.size(); ++m) {
    largest += numerics::hypot(profile.cosine[m], profile.sine[m]);
  }
  const double low = profile.location - profile.scale * largest;
  const double high = profile.location + profile.scale * largest;
  return profile.marginal == friction::Marginal::lognormal
             ? numerics::closed(numerics::exp_of_draws(low), numerics::exp_of_draws(high))
             : numerics::closed(low, high);
}

}  // namespace zerocount::distributions
