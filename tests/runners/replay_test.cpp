// A replayed trial is held against the recorded one, measure by measure.
#include "runners/replay.hpp"

#include <gtest/gtest.h>

namespace zerocount {
namespace {

MoveOutcome settled() {
  MoveOutcome move;
  move.outcome = Outcome::zero_count;
  move.arrived = move.stable = true;
  move.settling_time = 0.1;
  move.holding_torque = 0.0123456789;
  return move;
}

TEST(Replay, OfTheSameTrialHasNoDifferences) {
  EXPECT_TRUE(differences({settled(), MoveOutcome{}}, {settled(), MoveOutcome{}}).empty());
}

TEST(Replay, ForgivesTheLastDigitOfAnotherMachine) {
  MoveOutcome other = settled();
  other.holding_torque *= 1.0 + 1e-12;
  EXPECT_TRUE(differences({settled()}, {other}).empty());
}

TEST(Replay, NamesEveryMeasureThatDiffers) {
  MoveOutcome other = settled();
  other.outcome = Outcome::one_count;
  other.jerk_count = 3;
  other.holding_torque = 0.0124;
  const std::vector<std::string> lines = differences({settled(), settled()}, {settled(), other});
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].rfind("move 1: outcome: recorded 0, replayed 1", 0), 0u) << lines[0];
}

TEST(Replay, TellsNeverFromAValue) {
  MoveOutcome other = settled();
  other.settling_time = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(differences({settled()}, {other}).size(), 1u);
}

}  // namespace
}  // namespace zerocount
