#include "analysis/record_fit/angle_observations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/tools/roots.hpp>

namespace zerocount::record_fit {
namespace {

/// Variance of a uniform distribution of width 1.
constexpr double uniform_variance = 1.0 / 12.0;

/// Lower limit (counts) of the width of an edge observation, so that an edge passed within a thousandth of a
/// count does not outweigh all others.
constexpr double min_edge_width = 0.02;

/// Travel (counts) over which readings with noise are averaged.
constexpr double averaging_travel = 0.5;

/// Maximum travel (counts) between samples at which the noise is visible.
constexpr double max_quiet_travel = 0.2;

void observe_edges(const Eigen::VectorXd& path, const Eigen::VectorXd& readings,
                   std::vector<AngleObservation>& observations) {
  const Eigen::Index samples = path.size();
  double travel_before = 0.0;
  for (Eigen::Index k = 0; k < samples; ++k) {
    const double travel = k + 1 < samples ? std::abs(path[k + 1] - path[k]) : 0.0;
    const auto at = static_cast<std::size_t>(k);
    if (travel >= 1.0 || travel_before >= 1.0) {
      observations.push_back({at, at, readings[k] + 0.5, uniform_variance});
    }
    if (travel < 1.0 && k + 1 < samples && readings[k + 1] != readings[k]) {
      observations.push_back({at, at + 1, 0.5 * (readings[k] + readings[k + 1] + 1.0),
                              uniform_variance * (travel * travel + min_edge_width * min_edge_width)});
    }
    travel_before = travel;
  }
}

void observe_averages(const Eigen::VectorXd& path, const Eigen::VectorXd& readings, double noise,
                      std::vector<AngleObservation>& observations) {
  // The mean reading differs from the angle by a periodic error, whose first harmonic is damped by the noise.
  const double ripple =
      uniform_variance * std::exp(-4.0 * std::numbers::pi * std::numbers::pi * noise * noise);
  const double single = uniform_variance + noise * noise;
  const Eigen::Index samples = path.size();
  for (Eigen::Index first = 0; first < samples;) {
    Eigen::Index end = first;
    double sum = 0.0;
    while (end < samples && std::abs(path[end] - path[first]) < averaging_travel) sum += readings[end++];
    const auto count = static_cast<double>(end - first);
    observations.push_back({static_cast<std::size_t>(first), static_cast<std::size_t>(end - 1),
                            sum / count + 0.5, ripple + (single - ripple) / count});
    first = end;
  }
}

/// E|travel + √2·noise·z|, z standard normal: expected difference of two readings without rounding.
double expected_difference(double travel, double noise) {
  const double spread = std::numbers::sqrt2 * noise;
  if (spread <= 0.0) return travel;
  const double ratio = travel / spread;
  return spread * std::sqrt(2.0 / std::numbers::pi) * std::exp(-0.5 * ratio * ratio) +
         travel * std::erf(ratio / std::numbers::sqrt2);
}

void observe_all(const TestRecord& record, const Eigen::VectorXd& path, const Eigen::VectorXd& readings,
                 double noise, std::vector<AngleObservation>& observations) {
  if (record.counted && noise == 0.0) return observe_edges(path, readings, observations);
  if (record.counted) return observe_averages(path, readings, noise, observations);
  for (Eigen::Index k = 0; k < path.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    observations.push_back({at, at, readings[k], noise * noise});
  }
}

}  // namespace

void observe(const TestRecord& record, const Eigen::VectorXd& path, const Eigen::VectorXd& readings,
             double noise, std::vector<AngleObservation>& observations) {
  observations.clear();
  observe_all(record, path, readings, noise, observations);
  if (record.excluded.empty()) return;
  std::erase_if(observations, [&](const AngleObservation& observation) {
    const auto first = record.excluded.begin() + static_cast<std::ptrdiff_t>(observation.first);
    const auto end = record.excluded.begin() + static_cast<std::ptrdiff_t>(observation.last) + 1;
    return std::find(first, end, true) != end;
  });
}

double counting_noise(const TestRecord& record, const Eigen::VectorXd& path,
                      const Eigen::VectorXd& readings) {
  std::vector<double> travels;
  double observed = 0.0;  // counts between neighbouring readings
  double modelled = 0.0;  // rotor travel between them
  double edges = 0.0;     // count edges within that travel
  double turns = 1.0;
  double last_sign = 0.0;
  for (Eigen::Index k = 0; k + 1 < path.size(); ++k) {
    const double step = path[k + 1] - path[k];
    const auto sample = static_cast<std::size_t>(k);
    if (std::abs(step) >= max_quiet_travel) continue;
    // A straight line in place of masked readings does not follow the path's curve.
    if (is_excluded(record, sample) || is_excluded(record, sample + 1)) continue;
    travels.push_back(std::abs(step));
    observed += std::abs(readings[k + 1] - readings[k]);
    modelled += std::abs(step);
    edges += std::abs(std::floor(path[k + 1]) - std::floor(path[k]));
    if (step * last_sign < 0.0) turns += 1.0;
    if (step != 0.0) last_sign = step;
  }
  const auto excess = [&](double noise) {
    double expected = 0.0;
    for (const double travel : travels) expected += expected_difference(travel, noise);
    return expected - observed;
  };
  // Without noise, a monotonic stretch of the path passes as many edges as its length in counts, to within
  // one, and exactly the edges on the path, except near a turning point.
  const double by_chance = 3.0 + 2.0 * std::sqrt(turns);
  if (observed - modelled < by_chance || observed - edges < by_chance) return 0.0;
  constexpr double max_noise = 100.0;
  if (excess(max_noise) <= 0.0) return max_noise;
  constexpr int bits = 20;
  std::uintmax_t steps = 60;
  const auto bracket = boost::math::tools::bisect(excess, 0.0, max_noise,
                                                  boost::math::tools::eps_tolerance<double>(bits), steps);
  return 0.5 * (bracket.first + bracket.second);
}

}  // namespace zerocount::record_fit
