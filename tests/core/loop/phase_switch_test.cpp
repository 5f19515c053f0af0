// When a two-phase control changes its phase: thresholds, dwell, hysteresis, counting.
#include "core/loop/phase_switch.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace zerocount::loop {
namespace {

constexpr double sample_rate = 1000.0;

/// Fine within 10 counts, at most 2 counts a sample, for `dwell` samples; coarse beyond 50 counts.
CoarsePhaseParameters rule_with(int dwell) {
  return {.fine_within = 10.0, .fine_rate = 2.0, .fine_dwell = dwell / sample_rate, .coarse_beyond = 50.0};
}

/// One encoder closes the loop in both phases; the target is 0, so that the error is −count.
bool update(PhaseSwitch& rule, double count) {
  const Feedback feedback{-count, count};
  return rule.update(feedback, feedback);
}

/// The phases at successive samples.
std::vector<ControlPhase> phases(PhaseSwitch& rule, const std::vector<double>& counts) {
  std::vector<ControlPhase> result;
  for (const double count : counts) {
    update(rule, count);
    result.push_back(rule.phase());
  }
  return result;
}

constexpr ControlPhase fine = ControlPhase::fine;
constexpr ControlPhase coarse = ControlPhase::coarse;

TEST(PhaseSwitch, BeginsInThePhaseThatTheFirstErrorAsksForWhichIsNoChange) {
  for (const double count : {0.0, 50.0, -50.0, 51.0, -51.0}) {
    PhaseSwitch rule(rule_with(1), sample_rate);
    EXPECT_FALSE(update(rule, count));
    EXPECT_EQ(rule.phase(), std::abs(count) > 50.0 ? coarse : fine);
    EXPECT_EQ(rule.changes(), 0);
  }
}

TEST(PhaseSwitch, LeavesTheFinePhaseAtTheSampleBeyondTheLimitAndNotAtIt) {
  PhaseSwitch rule(rule_with(3), sample_rate);
  EXPECT_EQ(phases(rule, {0, 50, -50, 50.25}), (std::vector{fine, fine, fine, coarse}));
  EXPECT_EQ(rule.changes(), 1);
}

TEST(PhaseSwitch, EntersTheFinePhaseAtTheEndOfTheDwell) {
  PhaseSwitch rule(rule_with(3), sample_rate);
  EXPECT_EQ(phases(rule, {100, 10, 10, 8, 8}), (std::vector{coarse, coarse, coarse, coarse, fine}))
      << "the sample that comes down to 10 moved by 90";
  EXPECT_EQ(rule.changes(), 1);
}

TEST(PhaseSwitch, OneSampleOutsideEitherLimitBeginsTheDwellAnew) {
  for (const double disturbed : {11.0, 6.0}) {  // too far from the target; too large a movement
    PhaseSwitch rule(rule_with(3), sample_rate);
    phases(rule, {100, 9, 9, 9});
    EXPECT_EQ(rule.phase(), coarse);
    const double back = disturbed == 11.0 ? 9.0 : 6.0;
    EXPECT_EQ(phases(rule, {disturbed, back, back, back}), (std::vector{coarse, coarse, coarse, fine}));
  }
}

TEST(PhaseSwitch, BetweenTheLimitsThePhaseIsTheOneThatItWas) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> between(10.01, 50.0);
  PhaseSwitch in_fine(rule_with(1), sample_rate);
  PhaseSwitch in_coarse(rule_with(1), sample_rate);
  update(in_fine, 0.0);
  update(in_coarse, 60.0);
  for (int k = 0; k < 1000; ++k) {
    const double count = between(random) * (k % 2 == 0 ? 1.0 : -1.0);
    update(in_fine, count);
    update(in_coarse, count);
    ASSERT_EQ(in_fine.phase(), fine);
    ASSERT_EQ(in_coarse.phase(), coarse);
  }
  EXPECT_EQ(in_fine.changes() + in_coarse.changes(), 0);
}

TEST(PhaseSwitch, EveryChangeOfAChatteringControlIsCounted) {
  PhaseSwitch rule(rule_with(2), sample_rate);
  update(rule, 0.0);
  for (int cycle = 1; cycle <= 100; ++cycle) {
    EXPECT_TRUE(update(rule, 51.0));
    EXPECT_FALSE(update(rule, 0.0));
    EXPECT_FALSE(update(rule, 0.0));
    EXPECT_TRUE(update(rule, 0.0));
    EXPECT_EQ(rule.changes(), 2 * cycle);
  }
}

TEST(PhaseSwitch, DwellIsRoundedToWholeSamplesAndIsAtLeastOne) {
  const auto dwell_of = [](double time) {
    CoarsePhaseParameters parameters = rule_with(0);
    parameters.fine_dwell = time;
    PhaseSwitch rule(parameters, sample_rate);
    update(rule, 60.0);
    update(rule, 0.0);  // moved too far
    int samples = 0;
    while (rule.phase() == coarse) {
      update(rule, 0.0);
      ++samples;
    }
    return samples;
  };
  EXPECT_EQ(dwell_of(0.0), 1);
  EXPECT_EQ(dwell_of(0.0004), 1);
  EXPECT_EQ(dwell_of(0.0014), 1);
  EXPECT_EQ(dwell_of(0.0016), 2);
  EXPECT_EQ(dwell_of(0.010), 10);
}

TEST(PhaseSwitch, DwellLongerThanAnyTrialIsNeverOver) {
  for (const double time : {1e15, 1e17, 1e300}) {
    CoarsePhaseParameters parameters = rule_with(0);
    parameters.fine_dwell = time;
    PhaseSwitch rule(parameters, sample_rate);
    update(rule, 60.0);
    for (int k = 0; k < 100; ++k) EXPECT_FALSE(update(rule, 0.0));
  }
}

TEST(PhaseSwitch, EachPhaseIsLeftByItsOwnEncoder) {
  PhaseSwitch rule(rule_with(1), sample_rate);
  const Feedback near{0.0, 0.0};
  const Feedback far{1000.0, -1000.0};
  rule.update(near, far);
  EXPECT_FALSE(rule.update(near, far));  // the coarse phase's encoder does not count here
  EXPECT_TRUE(rule.update(far, far));
  EXPECT_FALSE(rule.update(near, far));  // nor the fine phase's here
  EXPECT_FALSE(rule.update(far, near));  // moved too far
  EXPECT_TRUE(rule.update(far, near));
  EXPECT_TRUE(rule.update(far, near));  // in the fine phase only its own encoder's error counts again
}

TEST(PhaseSwitch, SampleOfTheChangeIsTheFirstOfTheCoarsePhasesDwellAndNoneBeforeIt) {
  PhaseSwitch rule(rule_with(3), sample_rate);
  const Feedback near{0.0, 0.0};
  const Feedback far{1000.0, -1000.0};
  for (int k = 0; k < 10; ++k) rule.update(near, near);  // at rest, but in the fine phase
  EXPECT_TRUE(rule.update(far, near));
  EXPECT_EQ(rule.phase(), coarse);
  EXPECT_FALSE(rule.update(far, near));
  EXPECT_TRUE(rule.update(far, near));
  EXPECT_EQ(rule.phase(), fine);
}

}  // namespace
}  // namespace zerocount::loop
