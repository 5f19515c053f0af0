#include "analysis/jerks/observed_move.hpp"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace zerocount::jerks {
namespace {

std::vector<std::pair<std::int64_t, std::int64_t>> runs_of(const ObservedMove& move) {
  std::vector<std::pair<std::int64_t, std::int64_t>> runs;
  for_each_run_at_risk(move, [&](std::int64_t first, std::int64_t end) { runs.emplace_back(first, end); });
  return runs;
}

ObservedMove move_with(std::vector<SampledJerk> jerks) {
  return {.trial = 0,
          .cluster = 0,
          .arrived = true,
          .lost = false,
          .sample_time = 5e-4,
          .dwell = 100,
          .end = 200,
          .jerks = std::move(jerks)};
}

using Runs = std::vector<std::pair<std::int64_t, std::int64_t>>;

TEST(ObservedMove, IsAtRiskFromItsDwellToItsEnd) {
  EXPECT_EQ(runs_of(move_with({})), (Runs{{100, 200}}));
}

TEST(ObservedMove, IsNotAtRiskDuringAJerkNorAtTheSampleThatEndsIt) {
  // Samples 120 to 122 have errors, 123 is back at 0: the next jerk could begin at 124.
  EXPECT_EQ(runs_of(move_with({{120, 3, 1, true}})), (Runs{{100, 121}, {124, 200}}));
  EXPECT_EQ(runs_of(move_with({{100, 1, 1, true}, {102, 5, 1, true}})),
            (Runs{{100, 101}, {102, 103}, {108, 200}}));
}

TEST(ObservedMove, IsNoLongerAtRiskAfterAJerkThatLastsToItsEnd) {
  EXPECT_EQ(runs_of(move_with({{150, 50, 2, false}})), (Runs{{100, 151}}));
  EXPECT_EQ(runs_of(move_with({{199, 1, 1, true}})), (Runs{{100, 200}}));
}

}  // namespace
}  // namespace zerocount::jerks
