#include "analysis/identification/residual_checks.hpp"

#include <algorithm>
#include <cmath>

namespace zerocount {
namespace {

constexpr double least_chance = 0.01;

double spread_of(const ResidualStatistics& residuals) {
  return std::sqrt(residuals.squares / static_cast<double>(residuals.observations));
}

/// Share of the replicates for which `extreme` holds, the record itself counted as one of them.
template <class Extreme>
double share(const std::vector<ResidualStatistics>& replicates, Extreme extreme) {
  const auto count = std::count_if(replicates.begin(), replicates.end(), extreme);
  return static_cast<double>(count + 1) / static_cast<double>(replicates.size() + 1);
}

}  // namespace

ResidualChecks check_residuals(const ResidualStatistics& residuals,
                               const std::vector<ResidualStatistics>& replicates) {
  ResidualChecks checks;
  checks.observations = residuals.observations;
  checks.spread = spread_of(residuals);
  checks.runs = residuals.runs;
  checks.correlation_length = residuals.correlation_length;
  const auto count = static_cast<double>(replicates.size());
  checks.expected_correlation_length = 0.0;
  for (const ResidualStatistics& replicate : replicates) {
    checks.expected_spread += spread_of(replicate) / count;
    // As many observations as the record has.
    checks.expected_runs += replicate.runs / static_cast<double>(replicate.observations) *
                            static_cast<double>(residuals.observations) / count;
    checks.expected_correlation_length += replicate.correlation_length / count;
  }
  checks.spread_chance = share(
      replicates, [&](const ResidualStatistics& replicate) { return spread_of(replicate) >= checks.spread; });
  const auto off = [&](const ResidualStatistics& statistics) {
    const double scale =
        static_cast<double>(residuals.observations) / static_cast<double>(statistics.observations);
    return std::abs(statistics.runs * scale - checks.expected_runs);
  };
  const double off_here = off(residuals);
  checks.runs_chance =
      share(replicates, [&](const ResidualStatistics& replicate) { return off(replicate) >= off_here; });
  checks.passed = checks.spread_chance >= least_chance && checks.runs_chance >= least_chance;
  if (checks.passed) return checks;
  const double larger = std::max(1.0, checks.spread / checks.expected_spread);
  const double longer = std::max(1.0, checks.correlation_length / checks.expected_correlation_length);
  checks.widening = larger * std::sqrt(longer);
  return checks;
}

std::size_t largest_misfit_growth(const TestRecord& record, const Eigen::VectorXd& path) {
  constexpr Eigen::Index lag = 20;
  Eigen::Index fastest = 0;
  double largest = 0.0;
  for (Eigen::Index k = lag; k < path.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double change = record.reading[at] - path[k] - record.reading[at - lag] + path[k - lag];
    if (std::abs(change) <= largest) continue;
    largest = std::abs(change);
    fastest = k;
  }
  return static_cast<std::size_t>(fastest);
}

}  // namespace zerocount
