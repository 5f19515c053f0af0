
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/statistics/clusters/rig_statistics.hpp"
#include "analysis/statistics/sample_size.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::statistics {
namespace {

TEST(RigPlan, WithOneTrialARigIsThatOfIndependentTrials) {
  for (const double sd : {0.01, 0.2}) {
    EXPECT_NEAR(static_cast<double>(rigs_for_halfwidth(0.05, 0.95, 0.8, sd, 1)),
                static_cast<double>(trials_for_halfwidth(0.05, 0.95, 0.8)), 2.0);
  }
}

TEST(RigPlan, ManyTrialsLeaveWhatDiffersBetweenRigs) {
  // ±z·s/√R, with Student's t and Clopper–Pearson a little more.
  const auto rigs = static_cast<double>(rigs_for_halfwidth(0.02, 0.95, 0.8, 0.1, 100'000));
  EXPECT_NEAR(rigs, std::pow(1.96 * 0.1 / 0.02, 2), 0.08 * rigs);
  EXPECT_GT(rigs_for_halfwidth(0.02, 0.95, 0.8, 0.1, 10), rigs_for_halfwidth(0.02, 0.95, 0.8, 0.1, 100));
  EXPECT_THROW(rigs_for_halfwidth(0.02, 0.95, 0.9, 0.31, 10), Failure);  // s² > p(1 − p)
  EXPECT_THROW(rigs_for_halfwidth(0.6, 0.95, 0.9, 0.1, 10), Failure);
}

TEST(RigPlan, ToleranceIsShownWithSoManyTrialsAndNotWithFewer) {
  const auto shown = [](std::int64_t rigs, std::int64_t trials) {
    const RigTrials flawless{trials, trials, trials, trials};
    return rig_tolerance(std::vector<RigTrials>(static_cast<std::size_t>(rigs), flawless), 0.9, 0.95)
        .zero_at_least;
  };
  for (const std::int64_t rigs : {29, 40, 100, 250}) {
    const RigPlan plan = plan_tolerance(0.9, 0.97, 0.95, rigs);
    EXPECT_EQ(plan.rigs, rigs);
    EXPECT_GE(shown(rigs, plan.trials_per_rig), 0.97 * (1.0 - 1e-12));
    EXPECT_LT(shown(rigs, plan.trials_per_rig - 1), 0.97);
  }
  EXPECT_GE(plan_tolerance(0.9, 0.97, 0.95).rigs, 29);
  EXPECT_THROW(plan_tolerance(0.9, 0.97, 0.95, 28), Failure);
}

}  // namespace
}  // namespace zerocount::statistics
