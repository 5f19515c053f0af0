// Every measure of a move, on hand-made error sequences.
#include "core/trial/move_measures.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace zerocount {
namespace {

constexpr double sample_time = 0.001;  // s

struct Measured {
  MoveOutcome outcome;
  std::vector<Jerk> jerks;
};

/// Measures a move to `target` of the given errors, with a dwell of 3 and a window of 4 samples.
Measured measure(const std::vector<std::int64_t>& errors, std::int64_t target = 10, double torque = 0.1) {
  const MoveTiming timing{sample_time, static_cast<std::int64_t>(errors.size()), 3, 4};
  MoveMeasures measures(timing, 2);
  std::vector<Jerk> jerks;
  for (const std::int64_t error : errors) {
    if (measures.add({target, target - error, torque, false, 0.0, 0.0}))
      jerks.push_back(measures.last_jerk());
  }
  if (measures.finish(false, 0, true)) jerks.push_back(measures.last_jerk());
  return {measures.outcome(), jerks};
}

TEST(Arrival, IsTheFirstSampleOfTheFirstFullDwell) {
  EXPECT_EQ(measure({3, 1, 0, 0, 1, 0, 0, 0, 0}).outcome.arrival, 5);
  EXPECT_DOUBLE_EQ(measure({3, 1, 0, 0, 1, 0, 0, 0, 0}).outcome.settling_time, 0.005);
  EXPECT_EQ(measure({0, 0, 0, 1, 1}).outcome.arrival, 0);
  EXPECT_EQ(measure({5, 4, 0, 0, 0}).outcome.arrival, 2);  // the dwell may end with the move
}

TEST(Arrival, NeverIsNotANumber) {
  const MoveOutcome outcome = measure({3, 0, 0, 1, 0, 0, 1}).outcome;
  EXPECT_FALSE(outcome.arrived);
  EXPECT_EQ(outcome.arrival, -1);
  EXPECT_TRUE(std::isnan(outcome.settling_time));
  EXPECT_FALSE(outcome.stable);
}

TEST(OutcomeOfMove, IsDecidedByTheLastWindow) {
  EXPECT_EQ(measure({9, 5, 1, 0, 0, 0, 0}).outcome.outcome, Outcome::zero_count);
  EXPECT_EQ(measure({9, 5, 1, 0, 0, 0, -1}).outcome.outcome, Outcome::one_count);
  EXPECT_EQ(measure({9, 5, 0, 1, 0, 0, 0}).outcome.outcome,
            Outcome::one_count);  // the first of the last four
  EXPECT_EQ(measure({9, 5, 2, 0, 0, 0, 0}).outcome.outcome, Outcome::zero_count);
  EXPECT_EQ(measure({9, 5, 1, 0, 0, 2, 0}).outcome.outcome, Outcome::oscillating);
}

TEST(OutcomeOfMove, IsNonfiniteWhereTheMotionWasLost) {
  MoveMeasures measures({sample_time, 4, 3, 4}, 0);
  measures.add({1, 1, 0.0, false, 0.0, 0.0});
  measures.finish(false, 0, false);
  EXPECT_EQ(measures.outcome().outcome, Outcome::nonfinite);
  EXPECT_FALSE(measures.outcome().stable);
}

TEST(Stable, MeansArrivedAndNeverFurtherThanOneCountAfterwards) {
  EXPECT_TRUE(measure({5, 0, 0, 0, 1, -1, 0, 0}).outcome.stable);
  EXPECT_FALSE(measure({5, 0, 0, 0, 1, 2, 0, 0}).outcome.stable);
  EXPECT_TRUE(measure({5, 2, 0, 0, 0}).outcome.stable);  // before arrival anything goes
}

TEST(Jerks, AreTheExcursionsAfterTheDwell) {
  const Measured m = measure({5, 0, 0, 0, 0, -1, -1, 0, 0, 1, 0, -1, -2, -1, 0});
  ASSERT_EQ(m.jerks.size(), 3u);
  EXPECT_EQ(m.outcome.jerk_count, 3);
  EXPECT_EQ(m.jerks[0].move, 2);
  EXPECT_DOUBLE_EQ(m.jerks[0].onset, 0.005);
  EXPECT_DOUBLE_EQ(m.jerks[0].duration, 0.002);
  EXPECT_EQ(m.jerks[0].magnitude, 1);
  EXPECT_EQ(m.jerks[0].direction, 1);  // the count went beyond the target
  EXPECT_EQ(m.jerks[1].direction, -1);
  EXPECT_EQ(m.jerks[2].magnitude, 2);
  EXPECT_DOUBLE_EQ(m.jerks[2].duration, 0.003);
}

TEST(Jerks, DirectionIsThatOfTheOnset) {
  const Measured m = measure({0, 0, 0, -1, 1, 0, 0});
  ASSERT_EQ(m.jerks.size(), 1u);
  EXPECT_EQ(m.jerks[0].direction, 1);
}

TEST(Jerks, AreCutByTheEndOfTheMove) {
  const Measured m = measure({0, 0, 0, 0, 1, 1});
  ASSERT_EQ(m.jerks.size(), 1u);
  EXPECT_DOUBLE_EQ(m.jerks[0].duration, 0.002);
}

TEST(Jerks, AgreeWithTheHoldingTorqueInAShare) {
  const std::vector<std::int64_t> errors{0, 0, 0, -1, 0, -1, 0, 1, 0};
  EXPECT_DOUBLE_EQ(measure(errors, 10, 0.1).outcome.jerk_agreement, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(measure(errors, 10, -0.1).outcome.jerk_agreement, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(measure(errors, 10, 0.0).outcome.jerk_agreement, 0.0);
  EXPECT_TRUE(std::isnan(measure({0, 0, 0, 0}).outcome.jerk_agreement));
}

TEST(Overshoot, IsBeyondTheTargetInTheDirectionOfTheMove) {
  EXPECT_EQ(measure({5, 2, -3, -1, 0}).outcome.overshoot, 3);
  EXPECT_EQ(measure({-5, -2, 4, 1, 0}).outcome.overshoot, 4);
  EXPECT_EQ(measure({5, 6, 2, 0, 0}).outcome.overshoot, 0);   // going the wrong way first is not overshoot
  EXPECT_EQ(measure({0, 2, -2, 0, 0}).outcome.overshoot, 0);  // no move, no direction
}

TEST(Torques, ArePeakAndLast) {
  MoveMeasures measures({sample_time, 3, 1, 1}, 0);
  measures.add({0, 0, 0.1, false, 1.0, 0.5});
  measures.add({0, 0, -0.4, true, 2.0, 0.6});
  measures.add({0, 0, 0.2, false, 3.0, 0.7});
  measures.finish(true, 17, true);
  const MoveOutcome& outcome = measures.outcome();
  EXPECT_EQ(outcome.peak_torque, 0.4);
  EXPECT_EQ(outcome.holding_torque, 0.2);
  EXPECT_TRUE(outcome.saturated);
  EXPECT_TRUE(outcome.broke_away);
  EXPECT_EQ(outcome.reversal_depth, 17);
  EXPECT_EQ(outcome.final_position, 3.0);
  EXPECT_EQ(outcome.creep, 0.7);
}

TEST(FinalError, IsThatOfTheLastSample) {
  EXPECT_EQ(measure({9, 5, 1, 0, -3}).outcome.final_error, -3);
  EXPECT_EQ(measure({9, 5, 1, 0, 0}).outcome.final_error, 0);
}

// Without a target there is nothing to arrive at, and no verdict; what the rotor did is measured all the
// same.
TEST(OpenLoop, IsMeasuredButNotJudged) {
  MoveMeasures measures({.sample_time = sample_time, .samples = 6, .dwell = 2, .window = 2, .judged = false},
                        0);
  for (const std::int64_t count : {0, 0, 0, 1, 0, 7}) {
    EXPECT_FALSE(measures.add({0, count, -0.01 * static_cast<double>(count), false, 0.5, 0.25}));
  }
  EXPECT_FALSE(measures.finish(false, 3, true));
  const MoveOutcome& outcome = measures.outcome();
  EXPECT_EQ(outcome.outcome, Outcome::open_loop);
  EXPECT_FALSE(outcome.arrived);
  EXPECT_FALSE(outcome.stable);
  EXPECT_EQ(outcome.jerk_count, 0);
  EXPECT_EQ(outcome.overshoot, 0);
  EXPECT_EQ(outcome.final_error, -7);
  EXPECT_EQ(outcome.holding_torque, -0.07);
  EXPECT_EQ(outcome.peak_torque, 0.07);
  EXPECT_EQ(outcome.final_position, 0.5);
  EXPECT_EQ(outcome.creep, 0.25);
  EXPECT_EQ(outcome.reversal_depth, 3);
}

TEST(OpenLoop, IsNonfiniteWhereTheMotionWasLost) {
  MoveMeasures measures({.sample_time = sample_time, .samples = 6, .judged = false}, 0);
  measures.add({0, 0, 0.0, false, 0.0, 0.0});
  measures.finish(false, 0, false);
  EXPECT_EQ(measures.outcome().outcome, Outcome::nonfinite);
}

TEST(Timing, RoundsToWholeSamples) {
  TrialParameters parameters;
  parameters.command = {{1}, 0.15};
  parameters.verdict = {0.05, 0.0501};
  const MoveTiming timing = move_timing(parameters, 0);
  EXPECT_EQ(timing.samples, 300);
  EXPECT_EQ(timing.dwell, 100);
  EXPECT_EQ(timing.window, 100);
  EXPECT_DOUBLE_EQ(timing.sample_time, 5e-4);
}

}  // namespace
}  // namespace zerocount
