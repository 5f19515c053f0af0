// verdict.stop in the lanes: trials end at the same sample as in the reference, and like it.
#include "tests/core/batch/batched_trials.hpp"
#include "tests/core/batch/bench_trials.hpp"
#include "tests/core/batch/expect_agreement.hpp"
#include "tests/support/test.hpp"

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

// Motions that cannot be followed, or leave the numbers: the batch engine says so like the reference, and its
// other trials do not notice.

struct LostTrial {
  std::string name;
  trial::TrialParameters parameters;
};

std::vector<LostTrial> lost_trials() {
  const trial::TrialParameters sound = bench_trials("bench-transient", 3, 1).front();
  std::vector<LostTrial> trials;
  const auto add = [&](const char* name) -> trial::TrialParameters& {
    trials.push_back({name, sound});
    return trials.back().parameters;
  };
  add("a rotor without weight").plant.inertia = 1e-200;
  add("a rotor of next to no weight").plant.inertia = 1e-30;
  trial::TrialParameters& later = add("lost in its second move");
  later.plant.inertia = 1e-200;
  later.command.targets = {0, 5, 0};
  trial::TrialParameters& far = add("a slide out of the range of counts");
  far.initial.mode = trial::InitialMode::slide;
  far.initial.velocity = 1e16;
  trial::TrialParameters& quick = add("a slide beyond the numbers");
  quick.initial.mode = trial::InitialMode::slide;
  quick.initial.velocity = 1e308;
  add("a spring beyond the numbers").friction.uniform.k2 = 1e308;
  return trials;
}

TEST(BatchLosesAMotion, WhereTheReferenceDoesAndLikeIt) {
  int lost = 0;
  for (const LostTrial& trial : lost_trials()) {
    SCOPED_TRACE(trial.name);
    ASSERT_TRUE(batch::runs_in_lanes(trial.parameters));
    const BatchedTrial reference = run_by_reference(trial.parameters);
    const BatchedTrial batched = run_batch({trial.parameters}).front();
    ASSERT_EQ(batched.outcome.moves.size(), reference.outcome.moves.size());
    for (std::size_t m = 0; m < reference.outcome.moves.size(); ++m) {
      EXPECT_EQ(batched.outcome.moves[m].outcome, reference.outcome.moves[m].outcome) << "move " << m;
      lost += reference.outcome.moves[m].outcome == trial::Outcome::nonfinite;
    }
    EXPECT_EQ(batched.samples.size(), reference.samples.size());
    EXPECT_EQ(difference_in_bits({batched.outcome, {}, {}}, {reference.outcome, {}, {}}), "");
  }
  EXPECT_GE(lost, 5);
}

TEST(BatchLosesAMotion, WithoutTheOthersNoticing) {
  const std::vector<trial::TrialParameters> sound = bench_trials("bench-marginal", 0, 40);
  const std::vector<BatchedTrial> expected = run_batch(sound);
  std::vector<trial::TrialParameters> mixed = sound;
  for (const LostTrial& trial : lost_trials()) mixed.insert(mixed.begin() + 7, trial.parameters);
  const std::vector<BatchedTrial> results = run_batch(mixed, {.lanes = 16});
  const std::size_t lost = mixed.size() - sound.size();
  for (std::size_t i = 0; i < sound.size(); ++i) {
    EXPECT_EQ(difference_in_bits(expected[i], results[i < 7 ? i : i + lost]), "") << i;
  }
}

}  // namespace
}  // namespace zerocount::testing
