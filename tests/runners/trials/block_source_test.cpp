// The blocks of a run: which rows they have, and that the last ones are small.
#include "runners/trials/block_source.hpp"

#include "experiments/manifest/load_study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

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
