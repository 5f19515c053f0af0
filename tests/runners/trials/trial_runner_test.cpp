// Rows that a runner runs together have the results that each has alone.
#include "runners/trials/trial_runner.hpp"

#include <oneapi/tbb/task_arena.h>

#include "analysis/parallel/parallel.hpp"
#include "experiments/manifest/load_study.hpp"
#include "runners/trials/trial_set.hpp"
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

// Trials that are counted are divided evenly among the threads.

// The last blocks of the threads end together where each thread has as many.
TEST(TrialSet, EveryThreadHasAsManyBlocksForItsLanes) {
  std::mt19937_64 random(17);
  for (const int threads : {1, 2, 5, 16}) {
    const parallel::ThreadLimit limit(threads);
    oneapi::tbb::task_arena arena(threads);
    for (int round = 0; round < 300; ++round) {
      const auto all = std::uniform_int_distribution<std::int64_t>(1, 20'000)(random);
      const std::int64_t size = arena.execute([&] { return trials::block_for_lanes(all); });
      EXPECT_GE(size, 16);
      EXPECT_LE(size, 128);
      const std::int64_t blocks = (all + size - 1) / size;
      const std::int64_t of_one_thread = (blocks + threads - 1) / threads;
      if (size == 16) continue;  // few trials: the lanes need some
      EXPECT_LE(of_one_thread * size, all / threads + 1 + of_one_thread) << all << " on " << threads;
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
