// Rows that a runner runs together have the results that each has alone.
#include "runners/trials/trial_runner.hpp"

#include <chrono>
#include <stop_token>
#include <thread>

#include <oneapi/tbb/task_arena.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "experiments/manifest/load_study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"
#include "runners/trials/block_source.hpp"
#include "runners/trials/trial_set.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// A study with two gains as its design points. Trial 3 of each keeps its samples, and so runs on the
/// reference engine.
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

TEST(TrialRunner, ResultsEqualThoseOfEachTrialAlone) {
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

// A stop keeps what has ended.

/// Runs the rows as one block of trials, stopped after `milliseconds`.
trials::TrialBlock block_stopped_after(int milliseconds, const study::Study& study, layout::RowRange rows) {
  std::stop_source source;
  const std::jthread clock([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    source.request_stop();
  });
  return trials::TrialRunner(study).run_block(rows, source.get_token());
}

TEST(TrialRunner, AStoppedBlockKeepsTheTrialsBeforeTheFirstUnfinishedOne) {
  for (const study::Engine engine : {study::Engine::batch, study::Engine::reference}) {
    study::Study study = two_gains(engine);
    study.trials = 100'000;
    const layout::RowRange rows{study.trials - 20, 50'020};
    trials::TrialBlock stopped;
    for (int milliseconds = 1; stopped.results.empty(); milliseconds *= 2)
      stopped = block_stopped_after(milliseconds, study, rows);
    const std::int64_t ended = std::ssize(stopped.results);
    ASSERT_LT(ended, rows.count);
    const trials::TrialBlock whole = trials::TrialRunner(study).run_block({rows.first, ended});
    for (std::size_t i = 0; i < stopped.results.size(); ++i) {
      const shards::TrialResult& result = stopped.results[i];
      EXPECT_EQ(result.row, whole.results[i].row);
      EXPECT_EQ(result.inputs, whole.results[i].inputs);
      EXPECT_EQ(result.jerks.size(), whole.results[i].jerks.size());
      ASSERT_EQ(result.outcome.moves.size(), 1U);
      EXPECT_EQ(result.outcome.moves[0].final_error, whole.results[i].outcome.moves[0].final_error);
    }
    ASSERT_EQ(stopped.predictions.size(), whole.predictions.size());
    for (std::size_t i = 0; i < whole.predictions.size(); ++i)
      EXPECT_EQ(stopped.predictions[i].trials, whole.predictions[i].trials);
  }
}

// Trials that are counted are divided evenly among the threads.

// The last blocks of the threads end together where each thread has as many.
TEST(TrialSet, EveryThreadFillsItsLanes) {
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
  constexpr double trial_seconds = 1e-6;
  source.note(1, trial_seconds);
  while (const std::optional<trials::Block> block = source.next()) blocks.push_back(block->rows);
  return blocks;
}

/// A study with two design points for the batch engine.
/// @param trials number of trials at each point
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

// A kill loses at most the blocks in work.
TEST(BlockSource, SlowTrialsMakeSmallBlocks) {
  study::Study study = batch_study(50'000);
  const std::vector<RowRange> all{layout::all_rows(study)};
  trials::BlockSource lanes(study, all, 1);
  EXPECT_LE(lanes.next()->rows.count, 128);
  for (const double seconds : {0.01, 0.3, 40.0}) {
    lanes.note(1, seconds);
    EXPECT_EQ(lanes.next()->rows.count, std::max(static_cast<int>(1.0 / seconds), 1));
  }
  study.engine = study::Engine::reference;
  EXPECT_EQ(trials::BlockSource(study, all, 1).next()->rows.count, 1);
}

// Trials that lanes cannot run are as slow in the batch engine.
TEST(BlockSource, FirstBlocksAreSmallIfAPointNeedsTheReferenceEngine) {
  const study::Study study = manifest::parse_study(R"(zerocount: 1
name: gaps
seed: 7
trials: 5000
sweep: {grid: {plant.load.gap: [0, 1.0e-4]}}
plant: {load: {inertia: 1.0e-3, stiffness: 1.0e+3, damping: 0.1}}
command: {targets: [1], hold: 0.05}
)",
                                                   "axis.yaml", {});
  const std::vector<RowRange> all{layout::all_rows(study)};
  EXPECT_EQ(trials::BlockSource(study, all, 1).next()->rows.count, 1);
}

TEST(BlockSource, DividesAShortRunAmongTheThreads) {
  const study::Study study = batch_study(512);
  EXPECT_EQ(blocks_of(study, {layout::all_rows(study)}, 8).size(), 8);
  EXPECT_EQ(blocks_of(study, {layout::all_rows(study)}, 1).front().count, 512);
}

}  // namespace
}  // namespace zerocount::testing
