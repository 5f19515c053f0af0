#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "analysis/record/fit/observations.hpp"
#include "analysis/record/fit/residuals.hpp"
#include "analysis/record/fit/solver.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::fit {
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
