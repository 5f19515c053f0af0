#include "analysis/record/fit/observations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numerics/roots.hpp"

namespace zerocount::fit {
namespace {

/// Lower limit (counts) of the width of an edge observation, so that an edge passed within a thousandth of a
/// count does not outweigh all others.
constexpr double min_edge_width = 0.02;

/// Travel of the rotor, counts, over which readings with noise are averaged to one observation.
constexpr double averaging_travel = 0.5;

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

}  // namespace zerocount::fit
