// Coverage: of machines drawn at random, 95 % of the intervals hold the truth. A small part of what
// identification_coverage does at length.
#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>
#include <gtest/gtest.h>

#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount::testing {
namespace {

/// Smallest acceptable number of machines whose interval holds the true value. If each interval holds it with
/// 95 % probability, fewer hold it with a probability of 0.001 to 0.007. With intervals of 0.6 times the
/// correct width (coverage 76 %), the probability would be 0.7 for 24 machines and 0.15 for 3, and there are
/// nine parameters.
int least_held(int machines) {
  if (machines == 24) return 19;
  return machines == 12 ? 8 : 2;  // of 3
}

/// Quantile of the root mean square of the errors of `machines` estimates, each divided by its standard
/// error, if the standard errors are right.
double error_ratio(int machines, double probability) {
  return std::sqrt(boost::math::quantile(boost::math::chi_squared(machines), probability) / machines);
}

void expect_coverage(const CoverageStudy& study) {
  const int machines = study.sets;
  EXPECT_EQ(study.refused, 0);
  EXPECT_LE(study.lacking, 3);
  ASSERT_EQ(study.parameters.size(), 10u);
  for (const IntervalCoverage& coverage : study.parameters) {
    EXPECT_GE(coverage.estimated, machines - 1) << coverage.name;
    EXPECT_GE(coverage.held + machines - coverage.estimated, least_held(machines)) << coverage.name;
    // Nor are they wide for nothing: errors are what the standard errors say.
    const double ratio = std::sqrt(coverage.squared_errors / coverage.estimated);
    EXPECT_GT(ratio, error_ratio(machines, 2e-4)) << coverage.name;
    EXPECT_LT(ratio, error_ratio(machines, 1.0 - 2e-4)) << coverage.name;
  }
}

CoverageStudy of_counts_alone(int machines) {
  return study_coverage(1000, machines, short_test(), {}, {{}, 200});
}

CoverageStudy of_noisy_counts(int machines) {
  TestInstrument instrument;
  instrument.noise = 0.3;
  return study_coverage(2000, machines, short_test(), instrument, {{}, 200});
}

// A smoke test of the long ones below.
TEST(IdentificationCoverage, IntervalsCoverTheTrueValuesWithoutNoise) {
  expect_coverage(of_counts_alone(3));
}

TEST(IdentificationCoverage, DISABLED_IntervalsCoverTheTrueValuesOfManyMachinesWithoutNoise) {
  expect_coverage(of_counts_alone(24));
}

TEST(IdentificationCoverage, DISABLED_IntervalsCoverTheTrueValuesOfManyMachinesWithNoise) {
  expect_coverage(of_noisy_counts(12));
}

}  // namespace
}  // namespace zerocount::testing
