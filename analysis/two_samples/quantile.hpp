#pragma once

#include <cstdint>
#include <span>

#include "analysis/two_samples/sample.hpp"

/// Tests and bounds of a difference of quantiles. A positive difference is for the worse.
///
/// Two distributions have the same quantile q of probability p if as many of their values are at or above q:
/// the test compares the proportions of values at or above x, the sample quantile of the values of both
/// together. Where both have one distribution, x does not tell which value is of which file, so the tests of
/// proportions and means hold for these proportions as they do for any other. Values that are later than any
/// other are infinite and need no treatment of their own. Source: Mood's median test for another
/// probability; Conover, Practical Nonparametric Statistics (1999), section 4.3.
namespace zerocount::two_samples {

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
/// where the test rejects no, or every, difference.
Change change_of(const QuantileSample& sample, double confidence);

/// A sample of means that varies as the change of the quantile does, for a forecast. A quantile is to first
/// order the mean of what each unit has to do with it (Bahadur, Annals of Mathematical Statistics 37 (1966),
/// 577): its proportion of values at or above the quantile, times the scale with which their mean varies as
/// much as the bounds say.
/// @param change of the sample, with finite bounds @param standard_error of a normal distribution with these
Sample linearised(const QuantileSample& sample, const Change& change, double standard_error);

}  // namespace zerocount::two_samples
