#include "analysis/record/fit/observations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/record/fit/residuals.hpp"
#include "analysis/record/fit/solver.hpp"
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

namespace {

/// Sum Σ w·q² over the edges between counts that slow motion passes. Here q = e₋ − 2e + e₊ is the second
/// difference of the distances e of three successive edges from the path, without a reversal between them.
/// For an assumed noise of 0.03 counts the weight w is 1/Var(q).
struct EdgeDifferences {
  double squares{0.0};
  double weight{0.0};

  double mean() const { return weight > 0.0 ? squares / weight : 0.0; }
};

constexpr double of_second_difference = 6.0;  // Var(q)/Var(e)
constexpr double typical_noise = 0.03;        // counts

/// An edge between two counts of the encoder that the rotor passes between two samples.
struct PassedEdge {
  double distance;  ///< Distance of the edge from the modelled path, counts.
  double travel;    ///< Signed travel of the modelled path between the two samples, counts.
  double variance;  ///< Variance of the edge position if the encoder has no noise, counts².
};

void add_edges(const TestRecord& record, const Eigen::VectorXd& path, const Eigen::VectorXd& readings,
               EdgeDifferences& sum) {
  constexpr double slow = 0.25;  // counts per sample
  std::vector<AngleObservation> observations;
  observe(record, path, readings, 0.0, observations);
  std::array<PassedEdge, 3> edges{};
  for (const AngleObservation& observation : observations) {
    const auto at = static_cast<Eigen::Index>(observation.first);
    const double travel = observation.last > observation.first ? path[at + 1] - path[at] : 1.0;
    edges = {edges[1],
             edges[2],
             {observation.position - mean_over(observation, path).value(), travel, observation.variance}};
    const bool is_slow = std::all_of(edges.begin(), edges.end(), [&](const PassedEdge& edge) {
      return std::abs(edge.travel) < slow && edge.travel * travel > 0.0;
    });
    if (!is_slow) continue;
    const double difference = edges[0].distance - 2.0 * edges[1].distance + edges[2].distance;
    const double weight = 1.0 / (edges[0].variance + 4.0 * edges[1].variance + edges[2].variance +
                                 of_second_difference * typical_noise * typical_noise);
    sum.squares += weight * difference * difference;
    sum.weight += weight;
  }
}

}  // namespace

double edge_noise(Records records, const FittedModel& model, double unit) {
  // With readings of the paths moved by `place`, or with the recorded ones.
  const auto mean_difference = [&](std::optional<double> place) {
    EdgeDifferences sum;
    for (std::size_t r = 0; r < records.size(); ++r) {
      if (!records[r].counted || records[r].unit != unit) continue;
      const Eigen::VectorXd path = model.motions[r].path.array() + place.value_or(0.0);
      const Eigen::VectorXd noiseless = path.array().floor();
      add_edges(records[r], path, place ? noiseless : Eigen::VectorXd(readings_of(records[r])), sum);
    }
    return sum.mean();
  };
  constexpr int places = 32;  // of the path between two counts
  double largest = 0.0;
  double usual = 0.0;
  for (int i = 0; i < places; ++i) {
    const double noiseless = mean_difference((i + 0.5) / places);
    largest = std::max(largest, noiseless);
    usual += noiseless / places;
  }
  constexpr double margin = 1.2;  // the path is not exact
  const double observed = mean_difference(std::nullopt);
  if (observed <= margin * largest) return 0.0;
  return std::sqrt((observed - usual) / of_second_difference);
}

std::vector<double> noise_along(Records records, const FittedModel& model) {
  constexpr double min_noise = 1e-6;  // smaller residuals of angles are rounding errors
  std::vector<double> noise;
  std::map<double, double> of_encoder;  // by the size of its count
  for (std::size_t r = 0; r < records.size(); ++r) {
    const TestRecord& record = records[r];
    const Eigen::VectorXd& path = model.motions[r].path;
    noise.push_back(record.counted ? counting_noise(record, path, readings_of(record))
                                   : std::max(misfit_along(record, path), min_noise));
    if (!record.counted || noise[r] == 0.0) continue;
    const auto found = of_encoder.try_emplace(record.unit, noise[r]).first;
    found->second = std::min(found->second, noise[r]);
  }
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (noise[r] > 0.0) continue;
    const auto [found, is_new] = of_encoder.try_emplace(records[r].unit, 0.0);
    if (is_new) found->second = edge_noise(records, model, records[r].unit);
    noise[r] = found->second;
  }
  return noise;
}

}  // namespace zerocount::fit
