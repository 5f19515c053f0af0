#include "core/trial/disturbance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/numerics/elementary_functions.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::trial {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// Spectral density S at the frequency f (Hz), interpolated between the points a and b.
double density_between(const SpectrumPoint& a, const SpectrumPoint& b, double f) {
  if (a.density > 0.0 && b.density > 0.0) {
    const double part =
        numerics::log_of_draws(f / a.frequency) / numerics::log_of_draws(b.frequency / a.frequency);
    return a.density * numerics::exp_of_draws(part * numerics::log_of_draws(b.density / a.density));
  }
  return a.density + (b.density - a.density) * (f - a.frequency) / (b.frequency - a.frequency);
}

/// Mean square ∫S df from `low` to `high` (Hz), within the interval between the points a and b.
double mean_square_between(const SpectrumPoint& a, const SpectrumPoint& b, double low, double high) {
  const double at_low = density_between(a, b, low);
  const double at_high = density_between(a, b, high);
  if (a.density > 0.0 && b.density > 0.0) {
    // S = S₀·(f/f₀)^m, so ∫S df = S₀·f₀·L·(e^x − 1)/x, x = (m + 1)·L, L = ln(f₁/f₀).
    const double length = numerics::log_of_draws(high / low);
    const double slope =
        numerics::log_of_draws(b.density / a.density) / numerics::log_of_draws(b.frequency / a.frequency);
    const double x = (slope + 1.0) * length;
    const double mean = std::abs(x) < 1e-8 ? 1.0 + 0.5 * x : numerics::expm1_of_draws(x) / x;
    return at_low * low * length * mean;
  }
  return 0.5 * (at_low + at_high) * (high - low);
}

void add_lines(const SpectrumParameters& spectrum, const random::TrialRandomness& randomness,
               std::uint64_t first, std::vector<motion::Vibration>& vibration) {
  const random::RandomStream stream{randomness.spectrum, randomness.stream};
  const auto uniform = [&](std::uint64_t k) {
    return random::open_uniform(random::random_bits_at(stream, randomness.trial, k));
  };
  const double from = spectrum.density.front().frequency;
  const double range = numerics::log_of_draws(spectrum.density.back().frequency / from);
  for (int i = 0; i < spectrum.lines; ++i) {
    const auto edge = [&](double line) {
      return from * numerics::exp_of_draws(range * line / spectrum.lines);
    };
    const double power = mean_square(spectrum, edge(i), edge(i + 1));
    if (power == 0.0) continue;
    const std::uint64_t number = first + 2 * static_cast<std::uint64_t>(i);
    vibration.push_back(
        {std::sqrt(2.0 * power), two_pi * edge(i + uniform(number)), two_pi * uniform(number + 1)});
  }
}

}  // namespace

double mean_square(const SpectrumParameters& spectrum, double low, double high) {
  double sum = 0.0;
  for (std::size_t i = 1; i < spectrum.density.size(); ++i) {
    const SpectrumPoint& a = spectrum.density[i - 1];
    const SpectrumPoint& b = spectrum.density[i];
    const double from = std::max(low, a.frequency);
    const double to = std::min(high, b.frequency);
    if (from < to) sum += mean_square_between(a, b, from, to);
  }
  return sum;
}

std::vector<motion::Ripple> ripples_of(const std::vector<RippleParameters>& ripples, double position) {
  std::vector<motion::Ripple> along;
  for (const RippleParameters& ripple : ripples) {
    const double per_angle = ripple.pitch > 0.0 ? two_pi / ripple.pitch : ripple.periods;
    // The remainder keeps the digits of the phase far from the rotor's zero.
    const double phase = std::remainder(per_angle * position, two_pi) + ripple.phase;
    if (ripple.amplitude != 0.0) along.push_back({ripple.amplitude, per_angle, phase});
  }
  return along;
}

std::uint64_t random_lines(const DisturbanceParameters& parameters) {
  std::uint64_t lines = 0;
  for (const auto& spectrum : parameters.spectra) lines += static_cast<std::uint64_t>(spectrum->lines);
  return lines;
}

motion::Disturbance disturbance_of(const DisturbanceParameters& parameters, double position,
                                   const random::TrialRandomness& randomness, std::uint64_t lines) {
  motion::Disturbance disturbance{parameters.torque, ripples_of(parameters.ripple, position)};
  for (const VibrationParameters& line : parameters.vibration) {
    if (line.amplitude != 0.0)
      disturbance.vibration.push_back({line.amplitude, two_pi * line.frequency, line.phase});
  }
  std::uint64_t first = 2 * lines;
  for (const auto& spectrum : parameters.spectra) {
    add_lines(*spectrum, randomness, first, disturbance.vibration);
    first += 2 * static_cast<std::uint64_t>(spectrum->lines);
  }
  return disturbance;
}

}  // namespace zerocount::trial
