#pragma once

#include <span>

#include "analysis/statistics/proportion.hpp"

/// Tests and bounds of a difference of means by Student's t. A positive difference is for the worse.
namespace zerocount::two_samples {

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

}  // namespace zerocount::two_samples
