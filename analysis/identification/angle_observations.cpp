#include "analysis/identification/angle_observations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/tools/roots.hpp>

namespace zerocount {
namespace {

/// Variance of a uniform error of the width 1.
constexpr double uniform_variance = 1.0 / 12.0;

/// Width (counts) below which no edge is taken to be known: what is passed in a thousandth of a count would
/// otherwise outweigh all the rest.
constexpr double least_edge_width = 0.02;

/// Way (counts) within which readings with noise are averaged.
constexpr double averaging_way = 0.5;

/// Largest way (counts) between samples at which the noise shows beside it.
constexpr double slow = 0.2;

void observe_edges(const Eigen::VectorXd& path, const Eigen::VectorXd& readings,
                   std::vector<AngleObservation>& observations) {
  const Eigen::Index samples = path.size();
  double way_before = 0.0;
  for (Eigen::Index k = 0; k < samples; ++k) {
    const double way = k + 1 < samples ? std::abs(path[k + 1] - path[k]) : 0.0;
    const auto at = static_cast<std::size_t>(k);
    if (way >= 1.0 || way_before >= 1.0) {
      observations.push_back({at, at, readings[k] + 0.5, uniform_variance});
    }
    if (way < 1.0 && k + 1 < samples && readings[k + 1] != readings[k]) {
      observations.push_back({at, at + 1, 0.5 * (readings[k] + readings[k + 1] + 1.0),
                              uniform_variance * (way * way + least_edge_width * least_edge_width)});
    }
    way_before = way;
  }
}

void observe_averages(const Eigen::VectorXd& path, const Eigen::VectorXd& readings, double noise,
                      std::vector<AngleObservation>& observations) {
  // The mean reading over the noise differs from the angle by a ripple, whose first harmonic the noise damps.
  const double ripple =
      uniform_variance * std::exp(-4.0 * std::numbers::pi * std::numbers::pi * noise * noise);
  const double single = uniform_variance + noise * noise;
  const Eigen::Index samples = path.size();
  for (Eigen::Index first = 0; first < samples;) {
    Eigen::Index end = first;
    double sum = 0.0;
    while (end < samples && std::abs(path[end] - path[first]) < averaging_way) sum += readings[end++];
    const auto count = static_cast<double>(end - first);
    observations.push_back({static_cast<std::size_t>(first), static_cast<std::size_t>(end - 1),
                            sum / count + 0.5, ripple + (single - ripple) / count});
    first = end;
  }
}

/// E|way + √2·noise·z|, z standard normal: how far two readings differ on average, but for the rounding.
double expected_difference(double way, double noise) {
  const double spread = std::numbers::sqrt2 * noise;
  if (spread <= 0.0) return way;
  const double ratio = way / spread;
  return spread * std::sqrt(2.0 / std::numbers::pi) * std::exp(-0.5 * ratio * ratio) +
         way * std::erf(ratio / std::numbers::sqrt2);
}

}  // namespace

void observe(const TestRecord& record, const Eigen::VectorXd& path, const Eigen::VectorXd& readings,
             double noise, std::vector<AngleObservation>& observations) {
  observations.clear();
  if (record.counted && noise == 0.0) return observe_edges(path, readings, observations);
  if (record.counted) return observe_averages(path, readings, noise, observations);
  for (Eigen::Index k = 0; k < path.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    observations.push_back({at, at, readings[k], noise * noise});
  }
}

double counting_noise(const Eigen::VectorXd& path, const Eigen::VectorXd& readings) {
  std::vector<double> ways;
  double seen = 0.0;   // counts passed between neighbours
  double taken = 0.0;  // way of the rotor between them
  double edges = 0.0;  // on that way
  double turns = 1.0;
  double last_sign = 0.0;
  for (Eigen::Index k = 0; k + 1 < path.size(); ++k) {
    const double step = path[k + 1] - path[k];
    if (std::abs(step) >= slow) continue;
    ways.push_back(std::abs(step));
    seen += std::abs(readings[k + 1] - readings[k]);
    taken += std::abs(step);
    edges += std::abs(std::floor(path[k + 1]) - std::floor(path[k]));
    if (step * last_sign < 0.0) turns += 1.0;
    if (step != 0.0) last_sign = step;
  }
  const auto surplus = [&](double noise) {
    double expected = 0.0;
    for (const double way : ways) expected += expected_difference(way, noise);
    return expected - seen;
  };
  // Without noise, each way in one direction passes as many edges as it is long, give or take less than one;
  // and as many as there are on the path, but where that is a little off and turns near an edge.
  const double by_chance = 3.0 + 2.0 * std::sqrt(turns);
  if (seen - taken < by_chance || seen - edges < by_chance) return 0.0;
  constexpr double most = 100.0;
  if (surplus(most) <= 0.0) return most;
  constexpr int bits = 20;
  std::uintmax_t steps = 60;
  const auto bracket =
      boost::math::tools::bisect(surplus, 0.0, most, boost::math::tools::eps_tolerance<double>(bits), steps);
  return 0.5 * (bracket.first + bracket.second);
}

}  // namespace zerocount
