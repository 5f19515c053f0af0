// Trials that are counted are divided evenly among the threads.
#include "runners/trials/trial_set.hpp"

#include <oneapi/tbb/task_arena.h>

#include "analysis/parallel/parallel.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

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
