#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/record/fit/observations.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::fit {
namespace {

/// Lags (samples) of the differences from which noise is estimated: more than one, so that a steady motion
/// by part of a count per sample shows it as well.
constexpr Eigen::Index noise_lags = 2;

/// The distances of travels from the nearest whole count as a histogram, from 0 to ½ count. The nodes are
/// closer near 0, where the noise changes the expected differences most.
class TravelHistogram {
 public:
  void add(double distance, double weight) {
    const double at = std::sqrt(2.0 * distance) * last;
    const auto node = std::min(static_cast<std::size_t>(at), last - 1);
    const double part = (distance - distance_of(node)) / (distance_of(node + 1) - distance_of(node));
    weight_[node] += weight * (1.0 - part);
    weight_[node + 1] += weight * part;
  }

  /// Σ weight·value(distance) over the nodes of the histogram.
  template <class Value>
  double sum(Value value) const {
    double sum = 0.0;
    for (std::size_t i = 0; i <= last; ++i) {
      if (weight_[i] > 0.0) sum += weight_[i] * value(distance_of(i));
    }
    return sum;
  }

 private:
  static constexpr std::size_t last = 64;

  static double distance_of(std::size_t node) {
    const double root = static_cast<double>(node) / last;
    return 0.5 * root * root;
  }

  std::array<double, last + 1> weight_{};
};

/// ∫ over z > h of (z − h)·φ(z) dz: expected excess of a standard normal number over h.
double expected_excess(double h) {
  constexpr double root_two_pi = 2.5066282746310002;
  return std::exp(-0.5 * h * h) / root_two_pi - 0.5 * h * std::erfc(h / std::numbers::sqrt2);
}

/// Mean of (d − v)² over the phase of the counts, where d is the difference of two counts with independent
/// noise, and v the travel between them, `distance` counts from a whole number. Without noise it is the
/// variance f·(1 − f) of the count of edges in a travel with the fraction f. With noise the travel is v + δ,
/// and this variance plus δ² is a straight line in δ that bends by 2 at each whole count.
double expected_square(double distance, double noise) {
  const double spread = std::numbers::sqrt2 * noise;  // of δ
  constexpr double many_counts = 0.6;                 // beyond it the bends no longer show
  if (noise > many_counts) return 2.0 * noise * noise + 2.0 * uniform_variance;
  double square = distance * (1.0 - distance);
  if (spread <= 0.0) return square;
  for (double whole = -5.0; whole <= 5.0; ++whole)
    square += 2.0 * spread * expected_excess(std::abs(whole - distance) / spread);
  return square;
}

/// True if any reading from the sample `first` to the sample `last` is masked.
bool has_excluded(const TestRecord& record, Eigen::Index first, Eigen::Index last) {
  for (Eigen::Index k = first; k <= last; ++k) {
    if (is_excluded(record, static_cast<std::size_t>(k))) return true;
  }
  return false;
}

/// Largest difference between a change of the count and the travel that is taken for noise, counts: more is a
/// wrong reading.
double largest_difference(const Eigen::VectorXd& path, const Eigen::VectorXd& readings) {
  std::vector<double> differences;
  for (Eigen::Index k = 1; k < path.size(); ++k)
    differences.push_back(std::abs(readings[k] - readings[k - 1] - path[k] + path[k - 1]));
  constexpr double rounding = 2.5;
  constexpr double medians = 9.0;  // six standard deviations
  return rounding + medians * statistics::upper_median(differences);
}

double square_beside(double counts, double travel) {
  return (counts - travel) * (counts - travel);
}

}  // namespace

double counting_noise(const TestRecord& record, const Eigen::VectorXd& path,
                      const Eigen::VectorXd& readings) {
  if (path.size() < 2) return 0.0;
  const double largest = largest_difference(path, readings);
  TravelHistogram travels;
  double observed = 0.0;
  double noiseless = 0.0;  // weighted sum of squares, computed for the counts of the path
  double stretches = 1.0;  // number of parts of the path between reversals
  double last_sign = 0.0;
  for (Eigen::Index lag = 1; lag <= noise_lags; ++lag) {
    // Each lag sees the edges of slow motion again; the weight counts them once.
    const double weight = 1.0 / static_cast<double>(lag * noise_lags);
    for (Eigen::Index k = 0; k + lag < path.size(); ++k) {
      const double travel = path[k + lag] - path[k];
      const double counts = readings[k + lag] - readings[k];
      if (std::abs(counts - travel) > largest || has_excluded(record, k, k + lag)) continue;
      const double distance = std::abs(travel - std::round(travel));
      travels.add(distance, weight);
      observed += weight * square_beside(counts, travel);
      noiseless += weight * square_beside(std::floor(path[k + lag]) - std::floor(path[k]), travel);
      if (lag > 1 || travel == 0.0) continue;
      if (travel * last_sign < 0.0) stretches += 1.0;
      last_sign = travel;
    }
  }
  const auto excess = [&](double noise) {
    return travels.sum([&](double distance) { return expected_square(distance, noise); }) - observed;
  };
  // Without noise, a stretch of the path between two reversals has what is expected, to within the square of
  // an edge, and exactly what the path has, except near the reversals.
  const double by_chance = 3.0 + 2.0 * std::sqrt(stretches);
  if (-excess(0.0) < by_chance || observed - noiseless < by_chance) return 0.0;
  constexpr double max_noise = 100.0;
  if (excess(max_noise) <= 0.0) return max_noise;
  const auto is_less = [&](double noise) { return excess(noise) < 0.0; };
  const auto narrow = [](const numerics::Bracket& noise) {
    return noise.fails - noise.holds <= 0x1p-19 * noise.holds;
  };
  const auto [less, more] = numerics::bisect({0.0, max_noise}, is_less, narrow);
  return 0.5 * (less + more);
}

}  // namespace zerocount::fit
