#pragma once

#include "tests/support/test.hpp"

namespace zerocount::testing {

/// The confidence of every statement of these tests about a proportion of trials.
inline constexpr double study_confidence = 0.999;

/// Whether k of n trials show that the proportion of all trials is above (below) `proportion`. This is the
/// exact one-sided binomial test at the level 1 − study_confidence. Its answer changes at the one-sided
/// Clopper–Pearson bounds.
::testing::AssertionResult proportion_above(double proportion, std::int64_t k, std::int64_t n);
::testing::AssertionResult proportion_below(double proportion, std::int64_t k, std::int64_t n);

}  // namespace zerocount::testing
