// The binomial tests by which the studies are judged, against closed forms.
#include "tests/studies/proportion_bounds.hpp"

#include <cmath>

namespace zerocount::testing {
namespace {

TEST(ProportionBounds, WithoutFailuresHaveTheClosedForm) {
  const double bound = std::pow(0.001, 1.0 / 150.0);  // p¹⁵⁰ = 0.001
  EXPECT_TRUE(proportion_above(bound - 1e-9, 150, 150));
  EXPECT_FALSE(proportion_above(bound + 1e-9, 150, 150));
  EXPECT_TRUE(proportion_below(1.0 - bound + 1e-9, 0, 150));
  EXPECT_FALSE(proportion_below(1.0 - bound - 1e-9, 0, 150));
}

TEST(ProportionBounds, WithOneFailureSolveTheirEquation) {
  const auto at_most_one = [](double p) { return std::pow(1.0 - p, 20) + 20.0 * p * std::pow(1.0 - p, 19); };
  for (const double p : {0.30, 0.35, 0.40, 0.45}) {
    EXPECT_EQ(static_cast<bool>(proportion_below(p, 1, 20)), at_most_one(p) <= 0.001) << p;
    EXPECT_EQ(static_cast<bool>(proportion_above(1.0 - p, 19, 20)), at_most_one(p) <= 0.001) << p;
  }
}

TEST(ProportionBounds, ShowNothingWithoutTrialsAndNeverBothDirections) {
  EXPECT_FALSE(proportion_above(0.001, 0, 0));
  EXPECT_FALSE(proportion_below(0.999, 0, 0));
  for (std::int64_t k = 0; k <= 50; ++k)
    EXPECT_FALSE(proportion_above(0.5, k, 50) && proportion_below(0.5, k, 50)) << k;
}

}  // namespace
}  // namespace zerocount::testing
