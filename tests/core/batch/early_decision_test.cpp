// verdict.stop in the lanes: trials end at the same sample as in the reference, and like it.
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/batch/bench_trials.hpp"
#include "tests/core/batch/expect_agreement.hpp"

namespace zerocount::testing {
namespace {

TEST(BatchEarlyDecision, EndsATrialWhereTheReferenceDoes) {
  for (const double limit : {2.0, 20.0, 300.0, 1000.0}) {
    std::vector<trial::TrialParameters> trials;
    int stopped = 0, later = 0;
    for (std::uint64_t i = 0; i < 90; ++i) {
      constexpr TrialKind kinds[] = {TrialKind::ringing, TrialKind::calm, TrialKind::breaking_away};
      trials.push_back(trial_for_lanes(kinds[i % 3], 96000 + i));
      trials.back().verdict.stop = true;
      trials.back().verdict.limit = limit;
      const std::vector<trial::MoveOutcome> moves = trial::run_trial(trials.back()).moves;
      stopped += moves.back().stopped;
      later += moves.back().stopped && !moves.front().stopped;
    }
    expect_agreement_in_lanes(trials, "ended beyond " + std::to_string(limit));
    EXPECT_GT(stopped, 10);
    EXPECT_GT(later, 0);
  }
}

/// Trials that end give their lanes to others, which must not notice.
TEST(BatchEarlyDecision, LeavesNothingBehindForTheNextTrialOfTheLane) {
  std::vector<trial::TrialParameters> trials =
      bench_trials("bench-marginal", 0, 150, {"verdict.stop=true", "verdict.limit=30"});
  const std::vector<trial::TrialParameters> calm = bench_trials("bench-transient", 0, 150);
  trials.insert(trials.end(), calm.begin(), calm.end());
  const std::vector<BatchedTrial> few_lanes = run_batch(trials, {.lanes = 5});
  int stopped = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    stopped += few_lanes[i].outcome.moves.front().stopped;
    EXPECT_EQ(difference_in_bits(few_lanes[i], run_batch({trials[i]}).front()), "") << i;
  }
  EXPECT_GT(stopped, 50);
  EXPECT_LT(stopped, 200);
  expect_agreement_in_lanes(trials, "ended and calm ones");
}

}  // namespace
}  // namespace zerocount::testing
