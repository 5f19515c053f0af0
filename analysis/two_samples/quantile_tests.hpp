#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/statistics/proportion.hpp"

/// Tests and bounds of a difference of quantiles. A positive difference is for the worse.
///
/// Two distributions have the same quantile q of probability p if as many of their values are at or above q:
/// the test compares the proportions of values at or above x, the sample quantile of the values of both
/// together. Where both have one distribution, x does not tell which value is of which file, so the tests of
/// proportions and means hold for these proportions as they do for any other. Values that are later than any
/// other are infinite and need no treatment of their own. Source: Mood's median test for another
/// probability; Conover, Practical Nonparametric Statistics (1999), section 4.3.
namespace zerocount::two_samples {

/// One-sided p-values of no difference.
struct DirectionalP {
  double worse{1.0};   ///< against a change for the worse
  double better{1.0};  ///< against a change for the better
};

/// Tests units that failed (1) or not (0): by McNemar's exact test, or Fisher's.
/// @param baseline, current [unit]; @param paired unit i of both drew the same random numbers
DirectionalP p_of_failures(std::span<const double> baseline, std::span<const double> current, bool paired);
/// Tests the means of pairs: the larger p of signed ranks and the paired t. @param differences 2 or more
DirectionalP p_of_differences(std::span<const double> differences);
/// Tests the means of two samples: the larger p of Smirnov's test and Welch's t.
DirectionalP p_of_means(std::span<const double> baseline, std::span<const double> current);

/// The values of one file: `values_of_trial` of each trial after the other; trial i in cluster i mod
/// `clusters`, or each in one of its own (0). Independent are the clusters.
struct ClusteredValues {
  std::span<const double> values{};
  std::int64_t values_of_trial{1};
  std::int64_t clusters{0};
};

/// The sample quantile, current − baseline, with bounds that are one-sided, each with `confidence`: the
/// differences δ that the test does not reject of the baseline's values + δ and the current ones.
struct QuantileDifference {
  double baseline{0.0};  ///< infinite where the quantile is not reached
  double current{0.0};
  double effect{0.0};                       ///< infinite where one of them is; NaN where both are
  statistics::ConfidenceInterval bounds{};  ///< infinite where the test rejects no, or every, difference
  DirectionalP p{};
};

/// @param paired trial i, and each of its values, of both drew the same random numbers; both then have as
/// many
/// @param probability of the quantile
QuantileDifference quantile_difference(const ClusteredValues& baseline, const ClusteredValues& current,
                                       bool paired, double probability, double confidence);

/// The proportion of the values of each cluster that are at or above x.
std::vector<double> proportions_from(const ClusteredValues& values, double x);

/// The sample quantile of both together.
double pooled_quantile(const ClusteredValues& baseline, const ClusteredValues& current, double probability);

}  // namespace zerocount::two_samples
