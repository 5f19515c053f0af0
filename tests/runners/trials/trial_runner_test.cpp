// Rows that a runner runs together have the results that each has alone.
#include "runners/trials/trial_runner.hpp"

#include <oneapi/tbb/task_arena.h>

#include "analysis/parallel/parallel.hpp"
#include "experiments/manifest/load_study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"
#include "runners/trials/block_source.hpp"
#include "runners/trials/trial_set.hpp"
#include "tests/runners/program.hpp"
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

// The blocks of a run: which rows they have, and that the last ones are small.

using layout::RowRange;

std::vector<RowRange> blocks_of(const study::Study& study, const std::vector<RowRange>& ranges, int threads) {
  std::vector<RowRange> blocks;
  trials::BlockSource source(study, ranges, threads);
  while (const std::optional<trials::Block> block = source.next()) blocks.push_back(block->rows);
  return blocks;
}

/// Two points for the batch engine. @param trials of each
study::Study batch_study(std::int64_t trials) {
  const TemporaryFolder folder;
  folder.write("study.yaml", small_manifest(static_cast<int>(trials)));
  study::Study study = manifest::load_study(folder / "study.yaml", {});
  study.engine = study::Engine::batch;
  return study;
}

TEST(BlockSource, GivesEachRowOnceAndEndsABlockWithAChunk) {
  const study::Study study = batch_study(50'000);
  const std::vector<RowRange> ranges{{7, 20'000}, {30'000, 5}, {40'000, 50'000}};
  for (const int threads : {1, 3, 16, 200}) {
    std::vector<int> run(100'000);
    for (const RowRange& rows : blocks_of(study, ranges, threads)) {
      for (std::int64_t row = rows.first; row < rows.end(); ++row) ++run[static_cast<std::size_t>(row)];
      EXPECT_EQ(rows.first / layout::chunk_elements, (rows.end() - 1) / layout::chunk_elements);
    }
    for (const RowRange& range : ranges) {
      const auto first = run.begin() + range.first;
      EXPECT_EQ(std::count(first, first + range.count, 1), range.count);
    }
    EXPECT_EQ(std::accumulate(run.begin(), run.end(), 0), layout::total_rows(ranges));
  }
}

// What one thread has to do last is at most a small part of what all threads do.
TEST(BlockSource, MakesTheLastBlocksSmall) {
  const study::Study study = batch_study(8192);
  for (const int threads : {2, 16}) {
    std::int64_t remaining = 2 * study.trials;
    const std::vector<RowRange> blocks = blocks_of(study, {layout::all_rows(study)}, threads);
    for (const RowRange& rows : blocks) {
      EXPECT_LE(rows.count, std::max<std::int64_t>(remaining / (2 * threads), 128));
      remaining -= rows.count;
    }
    EXPECT_EQ(remaining, 0);
    EXPECT_LT(blocks.size(), 16 + 6 * threads);  // and not all of them
  }
}

TEST(BlockSource, DividesAShortRunAmongTheThreads) {
  const study::Study study = batch_study(512);
  EXPECT_EQ(blocks_of(study, {layout::all_rows(study)}, 8).size(), 8);
  EXPECT_EQ(blocks_of(study, {layout::all_rows(study)}, 1).front().count, 512);
}

}  // namespace
}  // namespace zerocount::testing
