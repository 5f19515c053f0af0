#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/pairs/comparison/point_judgements.hpp"
#include "analysis/pairs/two_samples/continued_sample.hpp"

/// Forecast of the number of trials that would decide a comparison, by simulating it with more trials.
namespace zerocount::comparison {

/// The samples of a comparison at all its design points, reduced to the sums that the simulations of the
/// forecast need. The memory does not grow with the number of trials.
class ForecastSamples {
 public:
  struct SampledMeasure {
    std::size_t point;
    TestedMeasure found;
    two_samples::ContinuedSample sample;
  };
  struct SampledRequirement {
    std::size_t point;
    /// The requirement, without the values of the independent units (`hits` and `events` are empty).
    RequirementSample asked;
    two_samples::BlockedSums sums;
  };

  /// @param units number of independent units (trials or machines) in the largest sample of the baseline and
  /// of the current file
  /// @param one_sample whether the samples of the current file represent the baseline too
  ForecastSamples(std::array<std::int64_t, 2> units, bool one_sample);

  /// Begins the next design point, which has these numbers of trials. All measures and requirements added
  /// afterwards belong to it.
  void add_point(std::int64_t baseline_trials, std::int64_t current_trials);
  /// Adds a measure of the design point that was added last. The measure must have enough values for a
  /// verdict.
  void add(const TestedMeasure& found, two_samples::Sample sample);
  void add(RequirementSample requirement);

  bool one_sample() const { return one_sample_; }
  const std::array<two_samples::Continuation, 2>& continuations() const { return continuations_; }
  const std::vector<SampledMeasure>& measures() const { return measures_; }
  const std::vector<SampledRequirement>& requirements() const { return requirements_; }
  /// Largest number of trials of any design point in the baseline (`file` = 0) or in the current file (`file`
  /// = 1); at least 1.
  std::int64_t trials_of(std::size_t file) const { return trials_[file]; }

 private:
  bool one_sample_;
  std::array<two_samples::Continuation, 2> continuations_;
  std::size_t points_{0};
  std::vector<SampledMeasure> measures_;
  std::vector<SampledRequirement> requirements_;
  std::array<std::int64_t, 2> trials_{1, 1};
};

struct ForecastOptions {
  double confidence{statistics::summary_confidence};  ///< Confidence of each one-sided bound of an effect.
  double false_discovery_rate{0.05};  ///< False discovery rate over all measures at all points.
  /// Confidence with which the data must contradict a requirement so that it fails.
  double failing_confidence{statistics::summary_confidence};
  /// Probability with which the forecast number of trials must decide the comparison.
  double probability{decision_probability};
  int simulations{400};     ///< Number of simulated comparisons for each number of trials that is tried.
  double factor_step{1.4};  ///< Ratio of successive numbers of trials that are tried.
  double min_factor{1.0};   ///< Smallest number of trials that is tried, as a multiple of the present number.
  double max_factor{100.0};  ///< Largest number of trials that is tried, as a multiple of the present number.
};

/// Reduces the work of a forecast with many judgements, so that it does not grow faster than that of the
/// comparison itself. Changes `options.simulations`, at most to an eighth, and makes the steps between the
/// numbers of trials twice as large on a logarithmic scale.
/// @param judgements number of judgements
void limit_work(ForecastOptions& options, std::size_t judgements);

/// The forecast for one judgement: a measure or a requirement at one point.
struct JudgementForecast {
  /// Number of trials per design point that decides this judgement by itself. Null if no number up to
  /// Forecast::max_trials suffices.
  std::optional<double> trials;
  /// For a measure: smallest margin that Forecast::max_trials trials decide, in the measure's unit.
  double margin{0.0};
};

struct Forecast {
  /// Number of trials per design point that decides the whole comparison. Null if no number up to max_trials
  /// suffices.
  std::optional<double> trials;
  double max_trials{0.0};  ///< Largest number of trials per design point that was tried.
  /// Forecasts of all measures in order, then of all requirements.
  std::vector<JudgementForecast> judgements;
};

/// The number of trials with which the whole comparison is decided with the stated probability: some measure
/// or requirement fails, or all pass. The simulations continue the present trials (Continuation), as the same
/// study with more trials would. Every simulated comparison has the tests, the adjustment and the margins of
/// the real one (ContinuedSample::change_of).
///
/// The number must suffice under two assumptions about the true effects:
/// - they are the effects seen, with their uncertainty;
/// - they are the effects seen, but each is zero with a probability that is estimated from the effects of all
///   measures together (a two-group mixture: Efron et al., Journal of the American Statistical Association 96
///   (2001), 1151).
/// The first assumption alone would promise decisions by regressions that do not exist; the second alone
/// misses small changes. README.md states the measured accuracy.
///
/// The result does not depend on the number of threads.
Forecast forecast_decision(const ForecastSamples& samples, const ForecastOptions& options);

/// The number of trials that each of two equal studies with different random numbers needs so that all
/// measures are found equivalent with the stated probability.
/// @param pilot samples of the trials of one study
Forecast forecast_equivalence(const ForecastSamples& pilot, const ForecastOptions& options);

/// [measure] Posterior probability that the true effect is zero.
/// @param z [measure] effect divided by its standard error. z is modelled by a mixture of N(0, 1) for zero
/// effects and N(0, 1 + 3²) for others. The weights are estimated from all z by expectation maximisation,
/// with one more measure of each kind.
std::vector<double> zero_difference_probabilities(const std::vector<double>& z);

}  // namespace zerocount::comparison
