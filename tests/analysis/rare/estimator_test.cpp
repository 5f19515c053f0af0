#include "analysis/rare/estimator.hpp"

#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/numerics/normal_distribution.hpp"

namespace zerocount::rare {
namespace {

/// A failure where `score` exceeds 0.
struct Case {
  std::string name;
  std::size_t coordinates;
  double probability;
  std::function<double(const std::vector<double>&)> score;
};

Simulation simulation_of(const Case& one) {
  return [&one](std::span<const TrialPoint> points) {
    std::vector<PointResult> results;
    for (const TrialPoint& point : points) {
      const double score = one.score(point.z);
      results.push_back({score > 0.0 ? 1.0 : 0.0, {score}});
    }
    return results;
  };
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const double p : {1e-4, 1e-5, 1e-6, 1e-8}) {
    const double beta = -numerics::normal_quantile(p);
    all.push_back({fmt::format("plane {}", p), 6, p, [beta](const std::vector<double>& z) {
                     double sum = 0.0;
                     for (const double x : z) sum += x;
                     return sum / std::sqrt(static_cast<double>(z.size())) - beta;
                   }});
    const double of_each = -numerics::normal_quantile(0.5 * p);
    all.push_back({fmt::format("two planes {}", p), 4, p,
                   [of_each](const std::vector<double>& z) { return std::abs(z[1]) - of_each; }});
    const double radius = -2.0 * std::log(p);
    all.push_back({fmt::format("circle {}", p), 5, p,
                   [radius](const std::vector<double>& z) { return z[0] * z[0] + z[3] * z[3] - radius; }});
    const double of_corner = -numerics::normal_quantile(std::sqrt(p));
    all.push_back({fmt::format("corner {}", p), 8, p,
                   [of_corner](const std::vector<double>& z) { return std::min(z[2], z[5]) - of_corner; }});
  }
  return all;
}

TEST(RareEstimator, BoundsHoldTheClosedForm) {
  for (const Case& one : cases()) {
    int held = 0, estimated = 0;
    double trials = 0, ratio = 0, final = 0, learn = 0, logs = 0;
    for (std::uint64_t seed = 1; seed <= (getenv("REP") ? atoi(getenv("REP")) : 40); ++seed) {
      EstimatorState state;
      const EstimatorSettings settings{one.coordinates, 1, 0.95, 2.0, seed};
      const Estimate e = estimate(state, settings, simulation_of(one),
                                  [](const EstimatorState& s) { return s.trials < 400000; });
      if (state.drawn.size() > 3000) {
        fmt::print("  {} seed {} final {} cap/p {:.1f} comps {} trials {}\n", one.name, seed,
                   state.drawn.size(), state.cap / one.probability, state.proposal.components.size(),
                   state.trials);
      }
      estimated += e.status == EstimateStatus::estimated;
      held += e.bounds.low <= one.probability && one.probability <= e.bounds.high;
      trials += state.trials / 40.0;
      ratio += e.probability / one.probability / 40.0;
      final += state.drawn.size() / 40.0;
      learn += state.learnings / 40.0;
      logs += std::log(state.searches.empty() ? 1 : state.searches[0].probability / one.probability) / 40;
    }
    fmt::print(
        "{:20} held {} estimated {} trials {:.0f} final {:.0f} learn {:.1f} mean/p {:.3f} split {:.2f}\n",
        one.name, held, estimated, trials, final, learn, ratio, std::exp(logs));
    fflush(stdout);
  }
}

}  // namespace
}  // namespace zerocount::rare
