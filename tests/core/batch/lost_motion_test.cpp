// Motions that cannot be followed, or leave the numbers: the batch engine says so like the reference, and its
// other trials do not notice.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/batch/batched_trials.hpp"
#include "tests/core/batch/bench_trials.hpp"

namespace zerocount::testing {
namespace {

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
