// encoder-noise and compensators: what noise leaves of zero counts, and what a dead zone of one count does.
#include <string>

#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t machine_trials = 100;

std::int64_t moves_at_zero(const std::string& study, const std::string& point) {
  return moves_with(outcomes_of(shipped_study(study), point, machine_trials),
                    [](const auto& move) { return move.outcome == trial::Outcome::zero_count; });
}

TEST(EncoderNoise, HidesZeroCountsWhateverTheGains) {
  EXPECT_TRUE(share_below(0.45, moves_at_zero("encoder-noise", "x1-zero"), machine_trials))
      << "an axis in the middle of its count shows 100 zeros in a row with a probability of 0.287";
}

TEST(EncoderNoise, LeavesOneCountAtTheResolutionOfThePaper) {
  const auto one_count = [](const auto& move) { return move.outcome == trial::Outcome::one_count; };
  const auto outcomes = outcomes_of(shipped_study("encoder-noise"), "x1", machine_trials);
  EXPECT_TRUE(share_above(0.5, moves_with(outcomes, one_count), machine_trials));
}

TEST(Compensators, LoseZeroCountsInAZoneOfOneCount) {
  EXPECT_TRUE(share_above(0.8, moves_at_zero("compensators", "plain"), machine_trials));
  EXPECT_TRUE(share_above(0.8, moves_at_zero("compensators", "standstill"), machine_trials));
  EXPECT_TRUE(share_below(0.45, moves_at_zero("compensators", "integral-zone-1"), machine_trials));
}

}  // namespace
}  // namespace zerocount::testing
