// The order in which the rows of a sweep run: points take turns.
#include "runners/trials/block_source.hpp"
#include "tests/support/test.hpp"

namespace zerocount::trials {
namespace {

using layout::RowRange;

/// Random ranges of rows in ascending order, with gaps, within 0 … rows.
std::vector<RowRange> random_ranges(std::mt19937& random, std::int64_t rows) {
  std::vector<RowRange> ranges;
  std::uniform_int_distribution<std::int64_t> step(0, rows / 3);
  for (std::int64_t row = step(random) / 4; row < rows;) {
    const std::int64_t count = std::min(step(random) + 1, rows - row);
    ranges.push_back({row, count});
    row += count + step(random) / 2 + 1;
  }
  return ranges;
}

class RotationOfRandomSweeps : public ::testing::TestWithParam<unsigned> {
 protected:
  std::mt19937 random{GetParam()};
  std::int64_t any(std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(random);
  }
};

TEST_P(RotationOfRandomSweeps, EachRowOfTheRangesRunsExactlyOnce) {
  const std::int64_t trials = any(1, 40), points = any(1, 12);
  const std::vector<RowRange> ranges = random_ranges(random, trials * points);
  std::vector<int> wanted(static_cast<std::size_t>(trials * points)), run = wanted;
  for (const RowRange& range : ranges) {
    for (std::int64_t row = range.first; row < range.end(); ++row) ++wanted[static_cast<std::size_t>(row)];
  }
  Turns turns(ranges, trials);
  while (!turns.is_empty()) {
    if (any(0, 3) == 0) turns.end_turn();
    const std::int64_t max_rows = any(1, 50);
    const RowRange rows = turns.upcoming(max_rows);
    ASSERT_GE(rows.count, 1);
    ASSERT_LE(rows.count, max_rows);
    const std::int64_t taken = any(1, rows.count);
    for (std::int64_t row = rows.first; row < rows.first + taken; ++row) ++run[static_cast<std::size_t>(row)];
    turns.take(taken);
  }
  EXPECT_EQ(run, wanted);
}

// A block has rows of one point, or ends where a point ends: tiny points share a block, and no other does.
TEST_P(RotationOfRandomSweeps, ABlockHoldsOnePointOrEndsWithAPoint) {
  const std::int64_t trials = any(1, 40), points = any(1, 12);
  Turns turns(random_ranges(random, trials * points), trials);
  while (!turns.is_empty()) {
    if (any(0, 3) == 0) turns.end_turn();
    const RowRange rows = turns.upcoming(any(1, 50));
    const bool of_one_point = rows.first / trials == (rows.end() - 1) / trials;
    turns.take(rows.count);
    EXPECT_TRUE(of_one_point || turns.is_at_new_point()) << rows.first << " " << rows.count;
  }
}

// Where no trial has been run before, no point is ahead of another by more than the longest turn.
TEST_P(RotationOfRandomSweeps, NoPointIsAheadByMoreThanOneRound) {
  const std::int64_t trials = any(20, 400), points = any(2, 12), block = any(1, 10);
  const std::vector<RowRange> all{{0, trials * points}};
  std::vector<std::int64_t> run(static_cast<std::size_t>(points));
  std::int64_t turn = 0, longest = 0;
  for (Turns turns(all, trials); !turns.is_empty();) {
    if (any(0, 2) == 0) {
      turns.end_turn();
      turn = 0;
    }
    const RowRange rows = turns.upcoming(block);
    for (std::int64_t row = rows.first; row < rows.end(); ++row)
      ++run[static_cast<std::size_t>(row / trials)];
    turns.take(rows.count);
    turn = turns.is_at_new_point() ? 0 : turn + rows.count;
    longest = std::max(longest, turn + rows.count);
    const auto [fewest, most] = std::minmax_element(run.begin(), run.end());
    EXPECT_LE(*most - *fewest, longest);
  }
}

// Of each point from its first trial on without gaps: trials of a machine or of a design depend on one
// another.
TEST_P(RotationOfRandomSweeps, TrialsOfAPointRunInOrder) {
  const std::int64_t trials = any(1, 40), points = any(1, 12);
  std::map<std::int64_t, std::int64_t> last;  // [point] row
  Turns turns(random_ranges(random, trials * points), trials);
  while (!turns.is_empty()) {
    if (any(0, 3) == 0) turns.end_turn();
    const RowRange rows = turns.upcoming(any(1, 50));
    for (std::int64_t row = rows.first; row < rows.end(); ++row) {
      const auto [before, is_first] = last.try_emplace(row / trials, row);
      EXPECT_TRUE(is_first || before->second < row);
      before->second = row;
    }
    turns.take(rows.count);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RotationOfRandomSweeps, ::testing::Range(1U, 41U));

TEST(RotationOfPoints, RunsTheFirstBlocksOfAllPointsThenTheSecond) {
  std::vector<RowRange> blocks;
  for (Turns turns(std::vector<RowRange>{{0, 60}}, 20); !turns.is_empty(); turns.end_turn()) {
    blocks.push_back(turns.upcoming(8));
    turns.take(8);
    if (blocks.size() == 6) break;
  }
  EXPECT_EQ(blocks, (std::vector<RowRange>{{0, 8}, {20, 8}, {40, 8}, {8, 8}, {28, 8}, {48, 8}}));
}

TEST(RotationOfPoints, AContinuedRunStartsWithThePointWithFewestTrials) {
  // Run before: all of point 0, half of point 1, nothing of point 2.
  Turns turns(std::vector<RowRange>{{15, 15}}, 10);
  EXPECT_EQ(turns.points(), 2);
  EXPECT_EQ(turns.upcoming(4), (RowRange{20, 4}));
}

}  // namespace
}  // namespace zerocount::trials
