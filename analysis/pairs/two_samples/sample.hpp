#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/unknown.hpp"

/// The change of one statistic between a baseline and a current sample. The statistic has one value for each
/// independent unit. A larger value, and a positive change, is worse.
///
/// Tests and bounds of a difference of quantiles. A positive difference is for the worse.
///
/// Two distributions have the same quantile q of probability p if as many of their values are at or above q:
/// the test compares the proportions of values at or above x, the sample quantile of the values of both
/// together. Where both have one distribution, x does not tell which value is of which file, so the tests of
/// proportions and means hold for these proportions as they do for any other. Values that are later than any
/// other are infinite and need no treatment of their own. Source: Mood's median test for another
/// probability; Conover, Practical Nonparametric Statistics (1999), section 4.3.
namespace zerocount::two_samples {

/// A statistic in both files, baseline and current. The units are the trials; if trials share machines or
/// worlds, these are the units.
struct Sample {
  /// True if each value is 1 (failed) or 0, so that the exact tests of counts apply.
  bool failures{false};
  bool paired{false};                 ///< True if unit i of both files drew the same random numbers.
  double plausible{1.0};              ///< Plausible difference of a single unit: `unit` of cautious_bounds().
  std::vector<double> baseline{};     ///< [unit] Value; NaN if the unit has none.
  std::vector<double> current{};      ///< [unit] Value; NaN if the unit has none.
  std::vector<double> differences{};  ///< [unit] current − baseline; only for pairs.
};

/// One-sided p-values of the hypothesis of no change, or of a change within a margin. A small value shows a
/// change.
struct DirectionalP {
  /// p-value against a change for the worse: small if the current sample is shown to be worse.
  double worse{1.0};
  /// p-value against a change for the better: small if the current sample is shown to be better.
  double better{1.0};
};

/// A change of a statistic, current − baseline (positive: worse), tested against a margin of 0 or more. Its
/// members are NaN if it was not tested.
struct Change {
  double effect{statistics::unknown};
  /// One-sided bounds of the change.
  statistics::ConfidenceInterval bounds{statistics::unknown, statistics::unknown};
  /// One-sided p-value of no change against a change for the worse: small if worse.
  double p{statistics::unknown};
  /// One-sided p-value of no change against a change for the better: small if better.
  double improvement_p{statistics::unknown};
  /// p-values of a change within ± margin: the larger one of p_of() and of the level at which a bound of
  /// change_of() reaches the margin.
  DirectionalP beyond{statistics::unknown, statistics::unknown};
};

/// The one-sided p-values of the hypothesis of no change. For failures: McNemar's exact test if paired,
/// otherwise Fisher's. For other values: the larger p of a rank test and a t-test, because both must show a
/// change. These are signed ranks and the paired t if paired, otherwise Smirnov's test and Welch's t.
DirectionalP p_of(const Sample& sample);

/// The change of the statistic with its p-values and one-sided bounds, each with `confidence`. For failures
/// the bounds are tango() if paired, otherwise newcombe(). For other values: cautious_bounds().
/// @param sample sample with two values or more
Change change_of(const Sample& sample, double confidence, double margin = 0.0);

/// The values without NaN.
std::vector<double> known(std::span<const double> values);

/// The mean of the values, none of which is NaN; NaN without values.
double mean_of(std::span<const double> values);

/// Difference of the means, with the standard error and the degrees of freedom for its bounds.
struct MeanDifference {
  double value{0.0};
  double standard_error{0.0};
  double degrees_of_freedom{0.0};
};

/// Mean of the differences of paired samples, with its standard error.
/// @param differences two or more, current − baseline
MeanDifference mean_difference(std::span<const double> differences);

/// Difference of the means of two independent samples with variances of their own (Welch, Biometrika 34
/// (1947), 28): current − baseline.
/// @param baseline two or more,
/// @param current two or more
MeanDifference mean_difference(std::span<const double> baseline, std::span<const double> current);

/// Mean difference of the known values of the sample: paired or of independent samples, as Sample::paired
/// says.
MeanDifference mean_difference(const Sample& sample);

/// One-sided p-value of no difference against a difference for the worse: P(t ≥ value/standard error).
/// Without any spread it is 0, ½ or 1.
double p_of(const MeanDifference& difference);

/// One-sided bounds of the mean difference, each with `confidence`. For each bound one more trial is added,
/// `unit` beyond the mean on the side of that bound, because the observed spread is too small if nearly all
/// differences are 0. In n trials without a difference the upper bound is about 2.7·unit/n; the rule of three
/// gives 3/n for the proportion of trials that might differ.
/// @param unit plausible difference of a single trial, greater than 0
statistics::ConfidenceInterval cautious_bounds(std::span<const double> differences, double unit,
                                               double confidence);
statistics::ConfidenceInterval cautious_bounds(std::span<const double> baseline,
                                               std::span<const double> current, double unit,
                                               double confidence);

/// The values of one file (baseline or current), trial by trial, `values_of_trial` for each. Trial i belongs
/// to cluster i mod `clusters`; if `clusters` is 0, each trial is a cluster. The clusters are independent.
struct ClusteredValues {
  std::span<const double> values{};
  std::int64_t values_of_trial{1};
  std::int64_t clusters{0};
};

/// The values of both files in clusters, and the probability of the compared quantile.
struct QuantileSample {
  ClusteredValues baseline{};
  ClusteredValues current{};
  /// True if trial i of both files, and each of its values, drew the same random numbers.
  bool paired{false};
  double probability{0.5};
};

/// The sample quantile of the values of one file; infinite if it falls among values that are later than any.
double quantile_of(const ClusteredValues& values, double probability);

/// The change of the sample quantile between the files, current − baseline: infinite if one of the quantiles
/// is, NaN if both are. The bounds enclose the differences δ for which the test does not reject that the
/// baseline's values + δ and the current values have the same quantile. They are infinite if the test rejects
/// no difference, or every difference. The p-values beyond the margin are those of the test of a shift by ±
/// margin.
Change change_of(const QuantileSample& sample, double confidence, double margin = 0.0);

/// A sample of means that varies as the change of the quantile does, for a forecast. A quantile is to first
/// order the mean of what each unit has to do with it (Bahadur, Annals of Mathematical Statistics 37 (1966),
/// 577): its proportion of values at or above the quantile, times the scale with which their mean varies as
/// much as the bounds say.
/// @param change change of the quantile in this sample, with finite bounds
/// @param standard_error standard error of a normal distribution with these
Sample linearised(const QuantileSample& sample, const Change& change, double standard_error);

}  // namespace zerocount::two_samples
