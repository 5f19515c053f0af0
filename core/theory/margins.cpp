#include "core/theory/margins.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "core/numerics/roots.hpp"
#include "core/theory/linear_loop.hpp"

namespace zerocount::theory {
namespace {

using Complex = std::complex<double>;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Replaces the margin by `other` if that is nearer to instability, `of_other` < `distance`; `distance` is
/// replaced too.
void adopt_nearer(Margin& margin, double& distance, const Margin& other, double of_other) {
  if (!(of_other < distance)) return;
  margin = other;
  distance = of_other;
}

/// The open-loop frequency response of a loop, evaluated at its search_angles().
SampledResponse response_of(const FrozenLoop& loop) {
  return sampled([open = open_loop(loop)](double angle) { return open.at_angle(angle); },
                 search_angles(loop));
}

double frequency_at(const FrozenLoop& loop, double angle) {
  return angle / (2.0 * std::numbers::pi * loop.sample_time);
}

/// Phase margin of an open-loop value L with |L| = 1: 180° + arg L, degrees.
double phase_margin(Complex value) {
  return std::arg(-value) * 180.0 / std::numbers::pi;
}

/// The highest gain crossover of the loop, with its phase margin.
/// @param crossovers all angles at which the response has gain 1, increasing.
GainCrossover highest_of(const FrozenLoop& loop, const SampledResponse& response,
                         const std::vector<double>& crossovers) {
  if (crossovers.empty() || std::abs(response.at(std::numbers::pi)) >= 1.0) return {none, none};
  return {frequency_at(loop, crossovers.back()), phase_margin(response.at(crossovers.back()))};
}

/// Whether the closed loop is stable with its gain multiplied by `factor`, or on the edge of stability within
/// rounding.
bool is_stable_with(FrozenLoop loop, double factor) {
  constexpr double rounding = 2e-8;  // of a double eigenvalue of exactly 1
  loop.plant.b *= factor;
  loop.plant.b_before *= factor;
  return log_growth(loop, loop.sample_time) <= rounding;
}

/// The factors of the loop's gain at which a closed-loop pole is on the unit circle, in increasing order,
/// each with its frequency.
std::vector<Margin> gains_on_circle(const FrozenLoop& loop, const SampledResponse& response) {
  std::vector<Margin> gains;
  const auto add = [&](Complex value, double angle) {
    // At half the sample rate a gain of 0 may round to a small one.
    constexpr double rounding = 1e-12;
    if (value.real() < -rounding) gains.push_back({1.0 / std::abs(value), frequency_at(loop, angle)});
  };
  for (const double angle : phase_crossovers(response)) add(response.at(angle), angle);
  // At half the sample rate L is a real number.
  add(open_loop(loop).at(-1.0), std::numbers::pi);
  std::ranges::sort(gains, {}, &Margin::value);
  return gains;
}

/// The gain factors, among `gains`, at which stability begins or ends. Between two neighbouring gains the
/// loop is either stable or unstable throughout.
std::vector<Margin> edges_of_stability(const FrozenLoop& loop, const std::vector<Margin>& gains) {
  constexpr double beyond = 1.5;  // the first or the last one
  std::vector<char> stable;       // [interval], the first one below all gains
  for (std::size_t i = 0; i <= gains.size() && !gains.empty(); ++i) {
    const double low = i == 0 ? gains.front().value / beyond : gains[i - 1].value;
    const double high = i == gains.size() ? gains.back().value * beyond : gains[i].value;
    stable.push_back(is_stable_with(loop, i == 0 ? low : i == gains.size() ? high : std::sqrt(low * high)));
  }
  std::vector<Margin> edges;
  for (std::size_t i = 0; i < gains.size(); ++i) {
    if (stable[i] != 0 || stable[i + 1] != 0) edges.push_back(gains[i]);
  }
  return edges;
}

}  // namespace

StabilityMargins stability_margins(const FrozenLoop& loop) {
  const SampledResponse response = response_of(loop);
  StabilityMargins margins{{none, none}, {none, none}, {none, none}};
  std::vector<Margin> gains = gains_on_circle(loop, response);
  if (!is_stable_with(loop, 1.0)) {
    gains = edges_of_stability(loop, gains);
    margins.no_gain_stabilises = gains.empty();
  }
  double distance = std::numeric_limits<double>::infinity();
  for (const Margin& gain : gains) adopt_nearer(margins.gain, distance, gain, std::abs(std::log(gain.value)));
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

}  // namespace zerocount::theory
