// The disturbance of a trial: lines drawn from a power spectral density, ripples along the rotor.
#include "core/trial/disturbance.hpp"

#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// A spectrum of some points over two to four decades.
trial::SpectrumParameters random_spectrum(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  trial::SpectrumParameters spectrum;
  double frequency = std::pow(10.0, uniform(-1.0, 1.0));
  for (std::uint64_t i = 2 + random() % 5; i > 0; --i) {
    spectrum.density.push_back({frequency, random() % 6 == 0 ? 0.0 : std::pow(10.0, uniform(-12.0, -8.0))});
    frequency *= std::pow(10.0, uniform(0.2, 1.0));
  }
  spectrum.lines = static_cast<int>(20 + random() % 100);
  return spectrum;
}

/// S at the frequency, straight between the points: on logarithmic axes, or on linear ones beside a zero.
double density_at(const trial::SpectrumParameters& spectrum, double f) {
  for (std::size_t i = 1; i < spectrum.density.size(); ++i) {
    const auto [f0, s0] = spectrum.density[i - 1];
    const auto [f1, s1] = spectrum.density[i];
    if (f > f1) continue;
    if (s0 == 0.0 || s1 == 0.0) return s0 + (s1 - s0) * (f - f0) / (f1 - f0);
    return s0 * std::pow(s1 / s0, std::log(f / f0) / std::log(f1 / f0));
  }
  return 0.0;
}

/// ∫S df by the midpoint rule in the logarithm of the frequency.
double integral(const trial::SpectrumParameters& spectrum, double low, double high) {
  constexpr int steps = 200000;
  const double ratio = std::pow(high / low, 1.0 / steps);
  double sum = 0.0;
  double f = low;
  for (int i = 0; i < steps; ++i, f *= ratio)
    sum += density_at(spectrum, f * std::sqrt(ratio)) * f * (ratio - 1.0);
  return sum;
}

motion::Disturbance drawn(const trial::SpectrumParameters& spectrum, std::uint64_t trial) {
  trial::DisturbanceParameters parameters;
  parameters.spectra.push_back(std::make_shared<const trial::SpectrumParameters>(spectrum));
  random::TrialRandomness randomness;
  randomness.trial = trial;
  randomness.spectrum = {3, 4};
  return trial::disturbance_of(parameters, 0.0, randomness);
}

TEST(DisturbanceSpectrum, MeanSquareOfABandIsTheIntegralOfTheDensity) {
  std::mt19937_64 random(20);
  for (int i = 0; i < 20; ++i) {
    const trial::SpectrumParameters spectrum = random_spectrum(random);
    const double first = spectrum.density.front().frequency;
    const double last = spectrum.density.back().frequency;
    const double from = first * std::pow(last / first, 0.2);
    const double to = first * std::pow(last / first, 0.7);
    for (const auto& [low, high] : {std::pair{first, last}, std::pair{from, to}}) {
      const double expected = integral(spectrum, low, high);
      EXPECT_NEAR(trial::mean_square(spectrum, low, high), expected, 1e-4 * expected + 1e-25) << i;
    }
  }
}

TEST(DisturbanceSpectrum, LinesHaveTheMeanSquareOfTheirBands) {
  std::mt19937_64 random(21);
  for (std::uint64_t i = 0; i < 20; ++i) {
    const trial::SpectrumParameters spectrum = random_spectrum(random);
    const double first = spectrum.density.front().frequency;
    const double last = spectrum.density.back().frequency;
    const motion::Disturbance disturbance = drawn(spectrum, i);
    const double edge = first * std::pow(last / first, std::floor(0.5 * spectrum.lines) / spectrum.lines);
    double all = 0.0;
    double below = 0.0;
    for (const motion::Vibration& line : disturbance.vibration) {
      const double frequency = line.rate / two_pi;
      EXPECT_GE(frequency, first);
      EXPECT_LE(frequency, last);
      all += 0.5 * line.amplitude * line.amplitude;
      if (frequency < edge) below += 0.5 * line.amplitude * line.amplitude;
    }
    const double total = trial::mean_square(spectrum, first, last);
    EXPECT_NEAR(all, total, 1e-9 * total);
    EXPECT_NEAR(below, trial::mean_square(spectrum, first, edge), 1e-9 * total);
    EXPECT_NE(disturbance.vibration.front().phase, drawn(spectrum, i + 1).vibration.front().phase);
  }
}

// The torque itself, over a time in which each line has many periods.
TEST(DisturbanceSpectrum, TorqueHasTheRmsOfTheDensity) {
  const trial::SpectrumParameters spectrum{{{2.0, 1e-10}, {20.0, 1e-9}, {200.0, 1e-12}}, 60};
  double sum = 0.0;
  constexpr int samples = 200000;
  const motion::Disturbance disturbance = drawn(spectrum, 5);
  for (int i = 0; i < samples; ++i) {
    const double torque = motion::value({disturbance, 1.17e-3 * i, 0.0});
    sum += torque * torque;
  }
  const double total = trial::mean_square(spectrum, 2.0, 200.0);
  EXPECT_NEAR(std::sqrt(sum / samples), std::sqrt(total), 0.02 * std::sqrt(total));
}

TEST(DisturbanceRipple, TurnsWithTheRotorFromItsPosition) {
  trial::DisturbanceParameters parameters;
  parameters.ripple = {{0.01, 36.0, 0.0, 0.4}, {0.02, 0.0, 1e-3, 0.1}, {0.0, 5.0, 0.0, 0.0}};
  const double position = 1.234;
  const motion::Disturbance disturbance = trial::disturbance_of(parameters, position, {});
  ASSERT_EQ(disturbance.ripple.size(), 2u);
  for (const double theta : {0.0, 1e-4, -0.02}) {
    const double expected = 0.01 * std::sin(36.0 * (theta + position) + 0.4) +
                            0.02 * std::sin(two_pi * (theta + position) / 1e-3 + 0.1);
    EXPECT_NEAR(motion::value({disturbance, 0.0, theta}), expected, 1e-12);
  }
}

}  // namespace
}  // namespace zerocount::testing
