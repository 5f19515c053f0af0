#include "core/theory/margins.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "core/numerics/minimum.hpp"
#include "core/theory/crossovers.hpp"
#include "core/theory/linear_loop.hpp"

namespace zerocount::theory {
namespace {

using Complex = std::complex<double>;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Replaces the margin by one with this distance from instability if that is smaller.
void adopt_nearer(Margin& margin, double& distance, const Margin& other, double of_other) {
  if (!(of_other < distance)) return;
  margin = other;
  distance = of_other;
}

/// The response of a loop between its search_angles.
SampledResponse response_of(const FrozenLoop& loop) {
  return sampled([open = open_loop(loop)](double angle) { return open.at_angle(angle); },
                 search_angles(loop));
}

double frequency_at(const FrozenLoop& loop, double angle) {
  return angle / (2.0 * std::numbers::pi * loop.sample_time);
}

/// 180° + arg L.
double phase_margin(Complex value) {
  return std::arg(-value) * 180.0 / std::numbers::pi;
}

/// @param crossovers all angles at which the response has gain 1, increasing
GainCrossover highest_of(const FrozenLoop& loop, const SampledResponse& response,
                         const std::vector<double>& crossovers) {
  if (crossovers.empty() || std::abs(response.at(std::numbers::pi)) >= 1.0) return {none, none};
  return {frequency_at(loop, crossovers.back()), phase_margin(response.at(crossovers.back()))};
}

}  // namespace

StabilityMargins stability_margins(const FrozenLoop& loop) {
  const SampledResponse response = response_of(loop);
  StabilityMargins margins{{none, none}, {none, none}, {none, none}};
  double distance = std::numeric_limits<double>::infinity();
  const auto add_gain = [&](Complex value, double angle) {
    // At half the sample rate a gain of 0 may round to a small one.
    constexpr double rounding = 1e-12;
    if (!(value.real() < -rounding)) return;
    const double factor = 1.0 / std::abs(value);
    adopt_nearer(margins.gain, distance, {factor, frequency_at(loop, angle)}, std::abs(std::log(factor)));
  };
  for (const double angle : phase_crossovers(response)) add_gain(response.at(angle), angle);
  // At half the sample rate L is a real number.
  add_gain(open_loop(loop).at(-1.0), std::numbers::pi);
  distance = std::numeric_limits<double>::infinity();
  const std::vector<double> crossovers = gain_crossovers(response);
  for (const double angle : crossovers) {
    const double margin = phase_margin(response.at(angle));
    adopt_nearer(margins.phase, distance, {margin, frequency_at(loop, angle)}, std::abs(margin));
  }
  margins.crossover = highest_of(loop, response, crossovers);
  return margins;
}

Margin peak_sensitivity(const FrozenLoop& loop) {
  constexpr int bits = 24;  // of the angle's logarithm
  const OpenLoop open = open_loop(loop);
  const auto distance_at = [&](double angle) { return std::abs(1.0 + open.at_angle(angle)); };
  const std::vector<double> angles = search_angles(loop);
  std::vector<double> distances;
  distances.reserve(angles.size());
  for (const double angle : angles) distances.push_back(distance_at(angle));
  // At half the sample rate L is a real number.
  double at_nearest = std::numbers::pi;
  double nearest = std::abs(1.0 + open.at(-1.0));
  for (std::size_t i = 1; i + 1 < angles.size(); ++i) {
    if (distances[i] > distances[i - 1] || distances[i] > distances[i + 1]) continue;
    // The variable is the logarithm of the angle, because the method also stops at an absolute tolerance.
    const auto [log_angle, distance] =
        numerics::minimum_between(std::log(angles[i - 1]), std::log(angles[i + 1]), bits,
                                  [&](double log) { return distance_at(std::exp(log)); });
    if (distance < nearest) std::tie(at_nearest, nearest) = std::pair(std::exp(log_angle), distance);
  }
  return {1.0 / nearest, frequency_at(loop, at_nearest)};
}

GainCrossover gain_crossover(const FrozenLoop& loop) {
  const SampledResponse response = response_of(loop);
  return highest_of(loop, response, gain_crossovers(response));
}

}  // namespace zerocount::theory
