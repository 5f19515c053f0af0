#pragma once

#include "analysis/statistics/proportion.hpp"
#include "analysis/two_samples/proportion_tests.hpp"

/// The tests of the comparison from sums alone, quick enough for simulations. They approximate p-values; the
/// bounds of proportions are those of the comparison.
namespace zerocount::two_samples {

/// Effect, bounds and the p-values against a change for the worse and for the better.
struct QuickResult {
  double effect{0.0};
  statistics::ConfidenceInterval bounds{};
  double p{1.0};
  double improvement_p{1.0};
};

/// McNemar's test by the normal distribution with a continuity correction, and Tango's bounds.
QuickResult quick_paired_proportion(const PairedFailures& failures, double confidence);

/// Fisher's test by the normal distribution with the hypergeometric variance and a continuity correction, and
/// Newcombe's bounds.
QuickResult quick_proportion(const FailureCounts& failures, double confidence);

/// Number of values, their sum and the sum of their squares.
struct ValueSums {
  double n{0.0};
  double sum{0.0};
  double squares{0.0};

  double mean() const { return sum / n; }
};

/// Student's t by the normal distribution (quantile: Cornish and Fisher's expansion; probability: Wallace's
/// approximation), with cautious_bounds().
/// @param plausible difference of a single unit
QuickResult quick_paired_mean(const ValueSums& differences, double plausible, double confidence);

/// Welch's t of two samples, approximated as quick_paired_mean().
QuickResult quick_mean(const ValueSums& baseline, const ValueSums& current, double plausible,
                       double confidence);

/// One-sided bounds of a mean as cautious_bounds() gives them, each with a confidence of its own.
statistics::ConfidenceInterval quick_mean_bounds(const ValueSums& values, double plausible,
                                                 double low_confidence, double high_confidence);

}  // namespace zerocount::two_samples
