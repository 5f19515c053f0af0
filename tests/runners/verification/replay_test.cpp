// A replayed trial is held against the recorded one: inputs, measures, jerks.
#include "runners/verification/replay.hpp"

#include "tests/support/test.hpp"

namespace zerocount {
namespace {

const std::vector<study::InputColumn> columns{{"friction.k1", "N m/rad", "stiffness"}};

shards::TrialResult settled() {
  trial::MoveOutcome move;
  move.outcome = trial::Outcome::zero_count;
  move.arrived = move.stable = true;
  move.arrival_time = 0.1;
  move.holding_torque = 0.0123456789;
  shards::TrialResult result;
  result.inputs = {110.0};
  result.outcome.moves = {move, trial::MoveOutcome{}};
  result.jerks = {{0, 0.2, 0.001, 1, 1}};
  return result;
}

TEST(Replay, TheSameTrialHasNoDifferences) {
  EXPECT_TRUE(verification::differences(columns, settled(), settled()).empty());
}

TEST(Replay, AllowsTheLastDigitOfAnotherComputer) {
  shards::TrialResult other = settled();
  other.outcome.moves[0].holding_torque *= 1.0 + 1e-12;
  other.inputs[0] *= 1.0 - 1e-13;
  EXPECT_TRUE(verification::differences(columns, settled(), other).empty());
}

TEST(Replay, NamesEveryMeasureThatDiffers) {
  shards::TrialResult other = settled();
  other.outcome.moves[1].outcome = trial::Outcome::one_count;
  other.outcome.moves[1].jerk_count = 3;
  other.outcome.moves[0].holding_torque = 0.0124;
  const std::vector<std::string> lines = verification::differences(columns, settled(), other);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].rfind("move 0: holding_torque: recorded 0.0123456789, replayed 0.0124", 0), 0u)
      << lines[0];
  EXPECT_EQ(lines[1].rfind("move 1: outcome: recorded 3, replayed 1", 0), 0u) << lines[1];
}

TEST(Replay, NeverDiffersFromAnyValue) {
  shards::TrialResult other = settled();
  other.outcome.moves[0].arrival_time = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(verification::differences(columns, settled(), other).size(), 1u);
}

TEST(Replay, ComparesTheMeasuresThatWereRecorded) {
  shards::TrialResult other = settled();
  other.outcome.moves[0].final_error = 3;
  other.outcome.moves[0].travel_time = 0.5;
  EXPECT_EQ(verification::differences(columns, settled(), other).size(), 2u);
  EXPECT_TRUE(verification::differences(columns, settled(), other, {}).empty());
}

TEST(Replay, ComparesInputsAndJerksToo) {
  shards::TrialResult other = settled();
  other.inputs[0] = 111.0;
  other.jerks[0].onset = 0.3;
  const std::vector<std::string> lines = verification::differences(columns, settled(), other);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], "input friction.k1: recorded 110, replayed 111");
  EXPECT_EQ(lines[1].rfind("jerk 0: onset", 0), 0u) << lines[1];
  other.jerks.clear();
  EXPECT_EQ(verification::differences(columns, settled(), other)[1], "jerks: recorded 1, replayed 0");
}

}  // namespace
}  // namespace zerocount
