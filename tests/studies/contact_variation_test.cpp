// contact-variation: the loop holds zero counts whether its contacts are alike or not (paper, QN1 and QN2).
#include <cmath>
#include <set>
#include <string>

#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t contact_trials = 60;

class Contacts : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(ContactVariation, Contacts, ::testing::Values("same", "varied"));

TEST_P(Contacts, EndTheirMovesInZeroCounts) {
  const auto outcomes = outcomes_of(shipped_study("contact-variation"), GetParam(), contact_trials);
  const std::int64_t moves = 6 * contact_trials;
  EXPECT_TRUE(share_above(0.97, moves_with(outcomes, [](const auto& move) { return move.stable; }), moves));
  EXPECT_TRUE(share_above(
      0.93, moves_with(outcomes, [](const auto& move) { return move.outcome == trial::Outcome::zero_count; }),
      moves));
  EXPECT_EQ(moves_with(outcomes, [](const auto& move) { return move.broke_away; }), moves)
      << "each move makes a new contact";
}

}  // namespace
}  // namespace zerocount::testing
