#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/unknown.hpp"

/// The change of one statistic between a baseline and what is compared with it: whatever the statistic is, it
/// is a value of each of the units that are independent. A larger value, and a positive change, is worse.
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

/// A statistic in both: the values of the trials, or of the machines or worlds where trials share these.
struct Sample {
  bool failures{false};               ///< each value is 1 (failed) or 0: for the exact tests of counts
  bool paired{false};                 ///< unit i of both drew the same random numbers
  double plausible{1.0};              ///< difference of a single unit, the `unit` of cautious_bounds()
  std::vector<double> baseline{};     ///< [unit]; NaN where the unit has no value
  std::vector<double> current{};      ///< [unit]
  std::vector<double> differences{};  ///< [unit] current − baseline; of pairs only
};

/// One-sided p-values of no change, or of a change within a margin.
struct DirectionalP {
  double worse{1.0};   ///< against a change for the worse
  double better{1.0};  ///< against a change for the better
};

/// A change, current − baseline, tested against a margin of 0 or more. Its members are unknown where it was
/// not tested.
struct Change {
  double effect{statistics::unknown};
  statistics::ConfidenceInterval bounds{statistics::unknown, statistics::unknown};  ///< each one-sided
  double p{statistics::unknown};              ///< of no change, against one for the worse
  double improvement_p{statistics::unknown};  ///< of no change, against one for the better
  /// p-values of a change within the margin: p_beyond().
  DirectionalP beyond{statistics::unknown, statistics::unknown};
};

/// The p-values of no change. Of failures by McNemar's exact test, or Fisher's. Of other values the larger p
/// of a rank test and a t-test, because both must show a change: signed ranks and the paired t, or Smirnov's
/// test and Welch's t.
DirectionalP p_of(const Sample& sample);

/// The p-values of a change within ± margin: the larger one of p_of() and of the level at which a bound of
/// change_of() reaches the margin.
DirectionalP p_beyond(const Sample& sample, double margin);

/// The change with p_of(), p_beyond() and bounds, each with `confidence`: of failures tango(), or newcombe();
/// of other values cautious_bounds(). @param sample with two values or more
Change change_of(const Sample& sample, double confidence, double margin = 0.0);

/// The values without NaN.
std::vector<double> known(std::span<const double> values);

/// The mean of known values; NaN without any.
double mean_of(std::span<const double> values);

/// Difference of the means, and what its bounds come from.
struct MeanDifference {
  double value{0.0};
  double standard_error{0.0};
  double degrees_of_freedom{0.0};
};

/// Paired samples: the mean of the differences.
/// @param differences two or more
MeanDifference mean_difference(std::span<const double> differences);

/// Two independent samples with variances of their own (Welch, Biometrika 34 (1947), 28): current −
/// baseline.
/// @param baseline two or more, @param current two or more
MeanDifference mean_difference(std::span<const double> baseline, std::span<const double> current);

/// Of the known values of the sample.
MeanDifference mean_difference(const Sample& sample);

/// P(t ≥ value/standard error): one-sided, against a difference for the worse. Without any spread 0, ½ or 1.
double p_of(const MeanDifference& difference);

/// One-sided bounds of the difference, each with `confidence`. For each bound one more trial is added, `unit`
/// beyond the mean on the side of that bound, because the observed spread is too small if nearly all
/// differences are 0. In n trials without a difference the upper bound is about 2.7·unit/n; the rule of three
/// gives 3/n for the proportion of trials that might differ.
/// @param unit plausible difference of a single trial, greater than 0
statistics::ConfidenceInterval cautious_bounds(std::span<const double> differences, double unit,
                                               double confidence);
statistics::ConfidenceInterval cautious_bounds(std::span<const double> baseline,
                                               std::span<const double> current, double unit,
                                               double confidence);

/// The values of one file: `values_of_trial` of each trial after the other; trial i in cluster i mod
/// `clusters`, or each in one of its own (0). Independent are the clusters.
struct ClusteredValues {
  std::span<const double> values{};
  std::int64_t values_of_trial{1};
  std::int64_t clusters{0};
};

/// Both files.
struct QuantileSample {
  ClusteredValues baseline{};
  ClusteredValues current{};
  bool paired{false};  ///< trial i, and each of its values, of both drew the same random numbers
  double probability{0.5};
};

/// The sample quantile of one file.
double quantile_of(const ClusteredValues& values, double probability);

/// The change of the sample quantile: infinite where one of them is, NaN where both are. Its bounds are the
/// differences δ that the test does not reject of the baseline's values + δ and the current ones; infinite
/// where the test rejects no, or every, difference. Its p-values beyond the margin are those of the test of a
/// shift by ± margin.
Change change_of(const QuantileSample& sample, double confidence, double margin = 0.0);

/// A sample of means that varies as the change of the quantile does, for a forecast. A quantile is to first
/// order the mean of what each unit has to do with it (Bahadur, Annals of Mathematical Statistics 37 (1966),
/// 577): its proportion of values at or above the quantile, times the scale with which their mean varies as
/// much as the bounds say.
/// @param change of the sample, with finite bounds @param standard_error of a normal distribution with these
Sample linearised(const QuantileSample& sample, const Change& change, double standard_error);

}  // namespace zerocount::two_samples
