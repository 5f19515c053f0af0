// Coverage: of rigs drawn at random, 95 % of the intervals hold the truth. A small share of what
// identification_coverage does at length.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/identification/material_tests.hpp"

namespace zerocount::testing {
namespace {

/// The chance that fewer hold of so many rigs' intervals, each with the chance of 95 %, is 1 to 2 in 1000.
/// With intervals 0.6 of the width that they should have (76 %) it would be 7 in 10 of 24 rigs, and there are
/// nine parameters.
int least_held(int rigs) {
  return rigs == 24 ? 19 : 8;  // of 12
}

void expect_coverage(const CoverageStudy& study) {
  const int rigs = study.sets;
  EXPECT_EQ(study.refused, 0);
  EXPECT_LE(study.lacking, 3);
  ASSERT_EQ(study.parameters.size(), 10u);
  for (const IntervalCoverage& coverage : study.parameters) {
    EXPECT_GE(coverage.estimated, rigs - 1) << coverage.name;
    EXPECT_GE(coverage.held + rigs - coverage.estimated, least_held(rigs)) << coverage.name;
    // Nor are they wide for nothing: errors are what the standard errors say.
    const double ratio = std::sqrt(coverage.squared_errors / coverage.estimated);
    EXPECT_GT(ratio, 0.55) << coverage.name;
    EXPECT_LT(ratio, 1.6) << coverage.name;
  }
}

TEST(IdentificationCoverage, IntervalsHoldTheTruthOfCountsAlone) {
  expect_coverage(study_coverage(1000, 24, short_test(), {}, {{}, 200}));
}

TEST(IdentificationCoverage, IntervalsHoldTheTruthOfNoisyCounts) {
  TestInstrument instrument;
  instrument.noise = 0.3;
  expect_coverage(study_coverage(2000, 12, short_test(), instrument, {{}, 200}));
}

}  // namespace
}  // namespace zerocount::testing
