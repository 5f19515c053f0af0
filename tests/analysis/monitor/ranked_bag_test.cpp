// Ranks in a growing multiset.
#include "analysis/monitor/ranked_bag.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/analysis/monitor/move_sequences.hpp"

namespace zerocount::testing {
namespace {

TEST(RankedBag, CountsLargerAndEqualValuesAsASearchThroughAllDoes) {
  random::NumberSource numbers = numbers_of("bag", 0);
  std::vector<double> all;
  for (int i = 0; i < 30; ++i) all.push_back(std::rint(20.0 * numbers.uniform()));
  monitor::RankedBag bag(all);
  for (int i = 0; i < 500; ++i) {
    const double value = i % 50 == 0 ? HUGE_VAL : std::rint(20.0 * numbers.uniform());
    const monitor::RankedBag::Place place = bag.place_of(value);
    EXPECT_EQ(place.above, std::ranges::count_if(all, [&](double one) { return one > value; }));
    EXPECT_EQ(place.equal, std::ranges::count(all, value));
    bag.insert(value);
    all.push_back(value);
    EXPECT_EQ(bag.size(), std::ssize(all));
  }
}

}  // namespace
}  // namespace zerocount::testing
