// The size of a search follows its effort.
#include "runners/tuning/race/search.hpp"
#include "tests/support/test.hpp"

namespace zerocount::tuning {
namespace {

TEST(SearchSize, FirstGenerationTakesHalfOfTheEffortAtMost) {
  for (std::size_t free = 1; free <= 6; ++free) {
    for (const std::int64_t worlds : {0, 7, 30}) {
      const SearchScope scope{free, free / 2, 2048, worlds};
      const std::int64_t least = first_race_units(smallest_search(scope), scope.faces);
      for (std::int64_t units = 2 * least; units < 1'000'000; units = units * 5 / 4) {
        const SearchSize size = search_size(scope, units);
        EXPECT_LE(first_race_units(size, scope.faces), units / 2);
        EXPECT_GE(size.max_units, size.first_units);
        EXPECT_EQ(size.max_units % std::max<std::int64_t>(worlds, 1), 0);
        EXPECT_GE(size.max_units, 4 * worlds) << "each world has some units";
      }
    }
  }
}

TEST(SearchSize, GrowsWithTheEffort) {
  const SearchScope scope{3, 3, 2048, 0};
  SearchSize last = smallest_search(scope);
  int sizes = 1;
  for (std::int64_t units = 500; units < 500'000; units = units * 6 / 5) {
    const SearchSize size = search_size(scope, units);
    EXPECT_GE(size.first_candidates, last.first_candidates);
    EXPECT_GE(size.max_units, last.max_units);
    sizes += size.first_candidates > last.first_candidates ? 1 : 0;
    last = size;
  }
  EXPECT_GT(sizes, 8) << "small efforts differ too";
  EXPECT_EQ(last.max_units, 2048);
}

}  // namespace
}  // namespace zerocount::tuning
