// encoder-resolution: a finer encoder helps until the converter is too coarse for it, or creep too slow.
#include <string>

#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t encoder_trials = 150;

std::vector<trial::TrialOutcome> outcomes_with(const std::string& encoder, const std::string& converter) {
  return outcomes_of(shipped_study("encoder-resolution"), encoder + ", dac.resolution=" + converter,
                     encoder_trials);
}

std::int64_t zero_count_moves(const std::vector<trial::TrialOutcome>& outcomes) {
  return moves_with(
      outcomes, [](const trial::MoveOutcome& move) { return move.outcome == trial::Outcome::zero_count; });
}

std::int64_t stable_count(const std::vector<trial::TrialOutcome>& outcomes) {
  return moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.stable; });
}

TEST(EncoderResolution, ThePapersConverterServesAnEncoderUpToFiveTimesAsFine) {
  EXPECT_TRUE(share_above(0.93, zero_count_moves(outcomes_with("tenth", "0.00024")), encoder_trials));
  EXPECT_TRUE(share_above(0.85, zero_count_moves(outcomes_with("five-times", "0.00024")), encoder_trials));
  EXPECT_TRUE(share_below(0.82, zero_count_moves(outcomes_with("ten-times", "0.00024")), encoder_trials));
}

TEST(EncoderResolution, AFinerConverterKeepsTheLoopStable) {
  EXPECT_TRUE(share_below(0.50, stable_count(outcomes_with("ten-times", "0.00024")), encoder_trials));
  EXPECT_TRUE(share_above(0.90, stable_count(outcomes_with("ten-times", "2.4e-05")), encoder_trials));
}

// A finer count is crossed by creep more often: without creep, all moves end in zero counts.
TEST(EncoderResolution, WhatIsLeftToAFineEncoderIsCreep) {
  EXPECT_TRUE(share_below(0.80, zero_count_moves(outcomes_with("ten-times", "2.4e-05")), encoder_trials));
  const study::Study study = shipped_study("encoder-resolution", {"friction.alpha=0"});
  EXPECT_TRUE(share_above(
      0.95, zero_count_moves(outcomes_of(study, "ten-times, dac.resolution=2.4e-05", encoder_trials)),
      encoder_trials));
}

}  // namespace
}  // namespace zerocount::testing
