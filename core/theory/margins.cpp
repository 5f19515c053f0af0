#include "core/theory/margins.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

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

}  // namespace

StabilityMargins stability_margins(const FrozenLoop& loop) {
  const auto response = [&](double angle) { return open_loop(loop, angle); };
  const auto frequency = [&](double angle) { return angle / (2.0 * std::numbers::pi * loop.sample_time); };
  const std::vector<double> angles = search_angles(loop);
  StabilityMargins margins{{none, none}, {none, none}};
  double distance = std::numeric_limits<double>::infinity();
  const auto add_gain = [&](Complex value, double angle) {
    // At half the sample rate a gain of 0 may round to a small one.
    constexpr double rounding = 1e-12;
    if (!(value.real() < -rounding)) return;
    const double factor = 1.0 / std::abs(value);
    adopt_nearer(margins.gain, distance, {factor, frequency(angle)}, std::abs(std::log(factor)));
  };
  for (const double angle : phase_crossovers(response, angles)) add_gain(response(angle), angle);
  // At half the sample rate L is a real number.
  add_gain(open_loop(Complex(-1.0), loop.plant, loop.controller), std::numbers::pi);
  distance = std::numeric_limits<double>::infinity();
  for (const double angle : gain_crossovers(response, angles)) {
    const double margin = std::arg(-response(angle)) * 180.0 / std::numbers::pi;
    adopt_nearer(margins.phase, distance, {margin, frequency(angle)}, std::abs(margin));
  }
  return margins;
}

Margin peak_sensitivity(const FrozenLoop& loop) {
  constexpr int bits = 24;  // of the angle's logarithm
  const auto distance_at = [&](double angle) { return std::abs(1.0 + open_loop(loop, angle)); };
  const std::vector<double> angles = search_angles(loop);
  std::vector<double> distances;
  distances.reserve(angles.size());
  for (const double angle : angles) distances.push_back(distance_at(angle));
  // At half the sample rate L is a real number.
  double at_nearest = std::numbers::pi;
  double nearest = std::abs(1.0 + open_loop(Complex(-1.0), loop.plant, loop.controller));
  for (std::size_t i = 1; i + 1 < angles.size(); ++i) {
    if (distances[i] > distances[i - 1] || distances[i] > distances[i + 1]) continue;
    // The variable is the logarithm of the angle, because the method also stops at an absolute tolerance.
    const auto [log_angle, distance] =
        numerics::minimum_between(std::log(angles[i - 1]), std::log(angles[i + 1]), bits,
                                  [&](double log) { return distance_at(std::exp(log)); });
    if (distance < nearest) std::tie(at_nearest, nearest) = std::pair(std::exp(log_angle), distance);
  }
  return {1.0 / nearest, at_nearest / (2.0 * std::numbers::pi * loop.sample_time)};
}

GainCrossover gain_crossover(const FrozenLoop& loop) {
  const auto response = [&](double angle) { return open_loop(loop, angle); };
  if (std::abs(response(std::numbers::pi)) >= 1.0) return {none, none};
  const std::vector<double> crossovers = gain_crossovers(response, search_angles(loop));
  if (crossovers.empty()) return {none, none};
  const double highest = crossovers.back();
  return {highest / (2.0 * std::numbers::pi * loop.sample_time),
          std::arg(-response(highest)) * 180.0 / std::numbers::pi};
}

}  // namespace zerocount::theory
