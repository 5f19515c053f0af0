#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/comparison/measure_comparison.hpp"

/// How many trials would decide a comparison, by simulation of the comparison with more trials.
namespace zerocount::comparison {

/// The samples of one design point, and the results of their comparison.
struct ForecastPoint {
  std::int64_t baseline_trials{0};
  std::int64_t current_trials{0};
  std::vector<MeasureSample> measures;  ///< with values enough for a verdict
  std::vector<TestedMeasure> found;     ///< [measure]
  std::vector<RequirementSample> requirements;
};

struct ForecastOptions {
  double confidence{0.95};            ///< of each bound
  double false_discovery_rate{0.05};  ///< over all measures at all points
  double failing_confidence{0.95};    ///< with which a requirement must be contradicted
  double probability{0.8};            ///< with which the number of trials decides
  int simulations{400};               ///< of each number of trials
  double min_factor{1.0};    ///< the fewest trials that are tried, as a multiple of those that there are
  double max_factor{100.0};  ///< the most trials that are tried, likewise
};

/// The forecast of one judgement.
struct JudgementForecast {
  std::optional<double> trials;  ///< per design point, that decide it by itself
  double margin{0.0};            ///< the smallest that max_trials decide; of a measure
};

struct Forecast {
  std::optional<double> trials;               ///< per design point, that decide the whole
  double max_trials{0.0};                     ///< per design point, the most that were tried
  std::vector<JudgementForecast> judgements;  ///< all measures in order, then all requirements
};

/// The number of trials with which the comparison as a whole is decided with the stated probability: some
/// measure or requirement fails, or all pass. The trials that there are go on (Continuation), as the same
/// study does with more trials; every simulated comparison has the tests, the adjustment and the margins of
/// the real one (tests: quick_tests.hpp; ranks keep the scores that they have in the sample).
///
/// The number must suffice under two assumptions of what the sample leaves open:
/// - the true effects are those that were seen, with their uncertainty;
/// - likewise, but each effect is nil with the probability that the effects of all measures together give it
///   (a two-group mixture: Efron et al., Journal of the American Statistical Association 96 (2001), 1151).
/// The first by itself promises decisions by regressions that are not there; the second misses small
/// changes. Its measured accuracy: README.md.
///
/// The result does not depend on the number of threads.
Forecast forecast_decision(const std::vector<ForecastPoint>& points, const ForecastOptions& options);

/// The number of trials of each of two equal studies, with different random numbers, with which all measures
/// are equivalent with the stated probability.
/// @param pilot its `current` samples are trials of the study; `baseline` is not used
Forecast forecast_equivalence(const std::vector<ForecastPoint>& pilot, const ForecastOptions& options);

/// For each measure the probability that its effect is nil: with z = e/s, the posterior of a mixture of
/// N(0, 1) and N(0, 1 + 3²), whose weights are estimated from all z by expectation maximisation, with one
/// measure more of each kind.
std::vector<double> nil_probabilities(const std::vector<double>& z);

}  // namespace zerocount::comparison
