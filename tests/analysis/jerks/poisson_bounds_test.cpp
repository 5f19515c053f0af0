#include <cmath>

#include <gtest/gtest.h>

#include "analysis/statistics/mean_bounds.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::jerks {
namespace {

/// SciPy 1.10: chi2.ppf(tail, 2k)/2 and chi2.isf(tail, 2k + 2)/2.
TEST(PoissonBounds, EqualSciPys) {
  struct {
    double events, confidence, low, high;
  } const scipy[] = {
      {0, 0.95, 0.0, 3.6888794541139354},
      {0, 0.99, 0.0, 5.298317366548036},
      {1, 0.9, 0.05129329438755053, 4.743864518390578},
      {1, 0.95, 0.025317807984289897, 5.571643390938898},
      {2, 0.99, 0.10349454674809108, 9.273792089255544},
      {5, 0.9, 1.97014956805953, 10.513034908741536},
      {5, 0.95, 1.623486390118421, 11.66833207932267},
      {20, 0.95, 12.216519585403946, 30.8883779026746},
      {100, 0.95, 81.36399125092315, 121.62679379242638},
      {1000, 0.99, 920.4240461633592, 1084.3728680643892},
  };
  for (const auto& [events, confidence, low, high] : scipy) {
    const statistics::ConfidenceInterval bounds = statistics::poisson_bounds(events, confidence);
    EXPECT_NEAR(bounds.low, low, 1e-10 * high) << events;
    EXPECT_NEAR(bounds.high, high, 1e-10 * high) << events;
  }
}

TEST(PoissonBounds, CoverEveryMeanWithAtLeastTheirConfidence) {
  for (double mean = 0.05; mean < 40.0; mean *= 1.13) {
    double covered = 0.0;
    for (int events = 0; events < 150; ++events) {
      const statistics::ConfidenceInterval bounds = statistics::poisson_bounds(events);
      if (mean < bounds.low || mean > bounds.high) continue;
      covered += std::exp(events * std::log(mean) - mean - std::lgamma(events + 1.0));
    }
    EXPECT_GE(covered, 0.95 - 1e-9) << mean;
  }
}

TEST(PoissonBounds, OfFractionsLieBetweenThoseOfWholeNumbers) {
  EXPECT_GT(statistics::poisson_bounds(2.5).low, statistics::poisson_bounds(2).low);
  EXPECT_LT(statistics::poisson_bounds(2.5).high, statistics::poisson_bounds(3).high);
}

TEST(PoissonBounds, ImpossibleNumbersAreRefused) {
  EXPECT_THROW(statistics::poisson_bounds(-1.0), Failure);
  EXPECT_THROW(statistics::poisson_bounds(std::nan("")), Failure);
  EXPECT_THROW(statistics::poisson_bounds(1.0, 1.0), Failure);
}

}  // namespace
}  // namespace zerocount::jerks
