// Rows that a runner runs together have the results that each has alone.
#include "runners/trials/trial_runner.hpp"

#include "experiments/manifest/load_study.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// Two points; trial 3 of each keeps its samples, and so runs on the reference engine.
study::Study two_gains(study::Engine engine) {
  study::Study study = manifest::parse_study(R"(zerocount: 1
name: two-gains
seed: 7
trials: 40
sweep: {grid: {controller.ki: [2.0e-5, 4.0e-5]}}
command: {targets: [{integers: [1, 9]}], hold: 0.05}
initial: {encoder_phase: {uniform: [0, 1]}}
verdict: {dwell: 0.01, window: 0.01}
retain: {trials: [3]}
)",
                                             "axis.yaml", {});
  study.engine = engine;
  return study;
}

TEST(TrialRunner, GivesRowsOfAnyPlacesTheResultsThatEachHasAlone) {
  const std::vector<std::int64_t> rows{71, 0, 43, 3, 40, 39, 12};
  for (const study::Engine engine : {study::Engine::batch, study::Engine::reference}) {
    const study::Study study = two_gains(engine);
    const std::vector<shards::TrialResult> together = trials::TrialRunner(study).run(rows);
    ASSERT_EQ(together.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const shards::TrialResult alone = trials::TrialRunner(study).run({rows[i], 1}).front();
      EXPECT_EQ(together[i].row, rows[i]);
      EXPECT_EQ(together[i].inputs, alone.inputs);
      EXPECT_EQ(together[i].jerks.size(), alone.jerks.size());
      EXPECT_EQ(together[i].trace.size(), alone.trace.size());
      EXPECT_EQ(together[i].trace.empty(), rows[i] % 40 != 3);
      ASSERT_EQ(together[i].outcome.moves.size(), 1U);
      EXPECT_EQ(together[i].outcome.moves[0].outcome, alone.outcome.moves[0].outcome);
      EXPECT_EQ(together[i].outcome.moves[0].holding_torque, alone.outcome.moves[0].holding_torque);
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
