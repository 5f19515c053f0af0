#pragma once

#include "tests/support/test.hpp"

namespace zerocount::testing {

/// The confidence of every statement that these tests make of a proportion of trials.
inline constexpr double study_confidence = 0.999;

/// Whether k of n trials show that the proportion of all trials is above (below) `proportion`: whether so
/// many (so few) would come with at most 1 − study_confidence if it were `proportion`. The exact binomial
/// test on one side, so that the one-sided bounds of Clopper and Pearson are the proportions at which the
/// answer changes.
::testing::AssertionResult share_above(double proportion, std::int64_t k, std::int64_t n);
::testing::AssertionResult share_below(double proportion, std::int64_t k, std::int64_t n);

}  // namespace zerocount::testing
