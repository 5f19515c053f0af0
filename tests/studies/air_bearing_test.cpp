// air-bearing: without friction the loop hunts by one count wherever a torque acts that the converter cannot
// balance, as the paper says of such systems (section 1); on a ball bearing the spring holds the difference.
#include <string>

#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t air_trials = 150;

std::int64_t moves_ending_in(const std::string& bearing, trial::Outcome outcome) {
  return moves_with(outcomes_of(shipped_study("air-bearing"), bearing, air_trials),
                    [outcome](const trial::MoveOutcome& move) { return move.outcome == outcome; });
}

TEST(AirBearing, HoldsZeroCountsOnlyWhereNothingDisturbsIt) {
  EXPECT_TRUE(share_above(0.95, moves_ending_in("air", trial::Outcome::zero_count), air_trials));
  EXPECT_TRUE(share_below(0.10, moves_ending_in("air-disturbed", trial::Outcome::zero_count), air_trials));
}

TEST(AirBearing, HuntsByOneCountUnderATorqueThatNoCodeBalances) {
  EXPECT_TRUE(share_above(0.90, moves_ending_in("air-disturbed", trial::Outcome::one_count), air_trials));
  EXPECT_TRUE(share_above(0.70, moves_ending_in("air-fine-dac", trial::Outcome::one_count), air_trials))
      << "nor does a fine converter help";
}

TEST(AirBearing, ABallBearingHoldsZeroCountsUnderTheSameDisturbance) {
  EXPECT_TRUE(share_above(0.86, moves_ending_in("ball", trial::Outcome::zero_count), air_trials));
}

}  // namespace
}  // namespace zerocount::testing
