#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/comparison/point_judgements.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/two_samples/continued_sample.hpp"

/// How many trials would decide a comparison, by simulation of the comparison with more trials.
namespace zerocount::comparison {

/// The samples of all design points, as the sums that simulations need: the memory does not grow with the
/// trials.
class ForecastSamples {
 public:
  struct Measure {
    std::size_t point;
    TestedMeasure found;
    two_samples::ContinuedSample sample;
  };
  struct Requirement {
    std::size_t point;
    RequirementSample asked;  ///< without its units
    two_samples::BlockedSums sums;
  };

  /// @param units number of independent units (trials or machines) of the largest sample of the baseline and
  /// of the file
  /// @param one_sample the samples of the file stand for the baseline too
  ForecastSamples(std::array<std::int64_t, 2> units, bool one_sample);

  /// Begins a design point with so many trials of the baseline and of the file.
  void add_point(std::int64_t baseline_trials, std::int64_t current_trials);
  /// Adds a measure of the point, which has values enough for a verdict.
  void add(const TestedMeasure& found, two_samples::Sample sample);
  void add(RequirementSample requirement);

  bool one_sample() const { return one_sample_; }
  const std::array<two_samples::Continuation, 2>& continuations() const { return continuations_; }
  const std::vector<Measure>& measures() const { return measures_; }
  const std::vector<Requirement>& requirements() const { return requirements_; }
  /// The most trials of a point of the baseline (0) or the file (1); at least 1.
  std::int64_t trials_of(std::size_t file) const { return trials_[file]; }

 private:
  bool one_sample_;
  std::array<two_samples::Continuation, 2> continuations_;
  std::size_t points_{0};
  std::vector<Measure> measures_;
  std::vector<Requirement> requirements_;
  std::array<std::int64_t, 2> trials_{1, 1};
};

struct ForecastOptions {
  double confidence{statistics::summary_confidence};  ///< of each bound
  double false_discovery_rate{0.05};                  ///< over all measures at all points
  double failing_confidence{
      statistics::summary_confidence};       ///< with which a requirement must be contradicted
  double probability{decision_probability};  ///< with which the number of trials decides
  int simulations{400};                      ///< of each number of trials
  double factor_step{1.4};   ///< Ratio of the numbers of trials that are tried one after the other.
  double min_factor{1.0};    ///< the fewest trials that are tried, as a multiple of those that there are
  double max_factor{100.0};  ///< the most trials that are tried, as such a multiple
};

/// Limits the simulations of a comparison with many judgements, so that their work grows no faster than the
/// comparison: at least an eighth of the usual ones, and of numbers of trials twice as far apart.
void limit_work(ForecastOptions& options, std::size_t judgements);

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
/// the real one (ContinuedSample::change_of).
///
/// The number must suffice under two assumptions of what the sample leaves open:
/// - the true effects are those that were seen, with their uncertainty;
/// - the effects seen, but each is zero with the probability that the effects of all measures together give
///   it (a two-group mixture: Efron et al., Journal of the American Statistical Association 96 (2001), 1151).
/// The first by itself promises decisions by regressions that are not there; the second misses small
/// changes. Its measured accuracy: README.md.
///
/// The result does not depend on the number of threads.
Forecast forecast_decision(const ForecastSamples& samples, const ForecastOptions& options);

/// The number of trials of each of two equal studies, with different random numbers, with which all measures
/// are equivalent with the stated probability.
/// @param pilot one sample: the trials of the study
Forecast forecast_equivalence(const ForecastSamples& pilot, const ForecastOptions& options);

/// For each measure the probability that its effect is zero: with z = e/s, the posterior of a mixture of
/// N(0, 1) and N(0, 1 + 3²), whose weights are estimated from all z by expectation maximisation, with one
/// measure more of each kind.
std::vector<double> zero_difference_probabilities(const std::vector<double>& z);

}  // namespace zerocount::comparison
