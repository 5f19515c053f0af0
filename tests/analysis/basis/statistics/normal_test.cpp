// The standard normal distribution, beside published values.
#include "analysis/basis/statistics/distributions.hpp"
#include "core/failure/failure.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

// Abramowitz and Stegun, tables 26.1 and 26.5, to more digits by mpmath.
TEST(Normal, HasThePublishedQuantilesAndTails) {
  EXPECT_NEAR(normal_quantile(0.95), 1.6448536269514722, 1e-14);
  EXPECT_NEAR(normal_quantile(0.05), -1.6448536269514722, 1e-14);
  EXPECT_NEAR(normal_upper_tail(1.0), 0.15865525393145705, 1e-16);
  EXPECT_NEAR(normal_upper_tail(6.0) / 9.865876450376981e-10, 1.0, 1e-12);
}

TEST(Normal, TailAndQuantileAreInverse) {
  for (double p = 0.001; p < 1.0; p += 0.037)
    EXPECT_NEAR(normal_upper_tail(normal_quantile(p)), 1.0 - p, 1e-15);
}

TEST(Normal, TwoSidedQuantileRefusesAConfidenceOutsideZeroToOne) {
  EXPECT_NEAR(two_sided_normal_quantile(0.95), 1.959963984540054, 1e-14);
  for (const double confidence : {0.0, 1.0, -0.1, std::nan("")})
    EXPECT_THROW(two_sided_normal_quantile(confidence), Failure);
}

}  // namespace
}  // namespace zerocount::statistics
