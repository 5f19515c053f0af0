// Which trials lanes run, and that those they do not run are told apart by every parameter that matters.
#include "tests/core/batch/batched_trials.hpp"
#include "tests/core/batch/bench_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

struct Change {
  const char* what;
  std::function<void(trial::TrialParameters&)> make;
};

trial::TrialParameters plain_trial() {
  return bench_trials("bench-transient", 0, 1).front();
}

TEST(RunsInLanes, IsFalseOfWhatLanesDoNotKnowWhichThenIsTheReferences) {
  const Change changes[] = {
      {"no moves", [](trial::TrialParameters& p) { p.command.targets = {}; }},
      {"no samples", [](trial::TrialParameters& p) { p.command.hold = 1e-5; }},
      {"a level without samples",
       [](trial::TrialParameters& p) {
         p.command.targets = {}, p.command.torque.levels = {0.1, 0.1}, p.command.hold = 0.0;
       }},
      {"a fast vibration",
       [](trial::TrialParameters& p) {
         p.disturbance.vibration = {{1e-3, 1100.0, 0.0}};
       }},
      {"a ripple without friction",
       [](trial::TrialParameters& p) {
         p.friction.model = friction::FrictionModel::none;
         p.disturbance.ripple = {{1e-3, 10.0, 0.0, 0.0}};
       }},
      {"seventeen elements",
       [](trial::TrialParameters& p) {
         p.friction.model = friction::FrictionModel::gms;
         p.friction.gms_elements.assign(17, {100.0, 1.0 / 17.0});
       }},
  };
  std::vector<trial::TrialParameters> trials;
  for (const Change& change : changes) {
    trials.push_back(plain_trial());
    change.make(trials.back());
    EXPECT_FALSE(batch::runs_in_lanes(trials.back())) << change.what;
  }
  const std::vector<BatchedTrial> batched = run_batch(trials, {.lanes = 4});
  for (std::size_t i = 0; i < trials.size(); ++i) {
    EXPECT_EQ(difference_in_bits(batched[i], run_by_reference(trials[i])), "") << changes[i].what;
  }
}

}  // namespace
}  // namespace zerocount::testing
