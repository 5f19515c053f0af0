// initial-conditions: where criterion (6) of the paper holds, the loop is stable whatever pre-sliding past
// the contact has; arrival from sliding is beyond it, and a matter for two phases.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "experiments/study/study.hpp"
#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

class StartInPresliding : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(InitialConditions, StartInPresliding,
                         ::testing::Values("virgin", "preloaded", "history", "moving", "integrator-preset"));

TEST_P(StartInPresliding, IsStableInAllTests) {
  const std::int64_t trials = 150;
  const auto outcomes = outcomes_of(shipped_study("initial-conditions"), GetParam(), trials);
  EXPECT_TRUE(proportion_above(
      0.95,
      moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.stable && !move.broke_away; }),
      trials));
  EXPECT_TRUE(proportion_above(
      0.93,
      moves_with(outcomes,
                 [](const trial::MoveOutcome& move) { return move.outcome == trial::Outcome::zero_count; }),
      trials));
}

TEST(InitialConditions, AllTrialsSatisfyCriterionSix) {
  const study::Study study = shipped_study("initial-conditions");
  for (const std::string& label : study.points.labels) {
    for (std::int64_t index = 0; index < study.trials; ++index) {
      const trial::TrialParameters p = trial_of(study, label, index);
      const double resolution = 2.0 * std::numbers::pi / p.encoder.fine;
      const double k_i = p.controller.ki * 2.0 * p.controller.sample_rate / resolution;  // N m/(rad s)
      EXPECT_LT(k_i, p.plant.presliding_damping * p.friction.uniform.k1 / p.plant.inertia);
    }
  }
}

TEST(InitialConditions, EachInitialHistoryIsAsDescribed) {
  const study::Study study = shipped_study("initial-conditions");
  std::set<std::int64_t> depths, targets;
  int moving = 0, preset = 0, sliding = 0;
  for (std::int64_t index = 0; index < 100; ++index) {
    const auto start = [&](const char* label) {
      trial::TrialParameters p = trial_of(study, label, index);
      p.command.hold = 0.1;
      return watched(p).samples.front();
    };
    EXPECT_EQ(start("virgin").depth, 0);
    EXPECT_GE(start("preloaded").depth, 1);
    depths.insert(start("history").depth);
    moving += std::abs(start("moving").omega) > 0.02;
    preset += std::abs(start("integrator-preset").torque) > 0.01;
    sliding += start("from-sliding").mode == trial::HookMode::slide;
    targets.insert(trial_of(study, "history", index).command.targets[0]);
  }
  EXPECT_GE(*depths.rbegin(), 5) << "reversal points that survived";
  EXPECT_GE(depths.size(), 5u);
  EXPECT_TRUE(proportion_above(0.7, moving, 100));
  EXPECT_TRUE(proportion_above(0.7, preset, 100));
  EXPECT_EQ(sliding, 100);
  EXPECT_LT(*targets.begin(), 0);
  EXPECT_GT(*targets.rbegin(), 0);
}

TEST(InitialConditions, FromSlidingTheFineGainsBreakTheContactAgain) {
  const study::Study study = shipped_study("initial-conditions");
  const std::int64_t trials = 100;
  std::int64_t stable = 0, broken_again = 0;
  std::int64_t smallest_rebound = 1000000;
  for (std::int64_t index = 0; index < trials; ++index) {
    const WatchedTrial trial = watched(trial_of(study, "from-sliding", index));
    stable += trial.outcome.moves[0].stable;
    const auto stuck = std::find_if(trial.samples.begin(), trial.samples.end(),
                                    [](const auto& sample) { return sample.mode == trial::HookMode::stick; });
    const auto slid = std::find_if(stuck, trial.samples.end(),
                                   [](const auto& sample) { return sample.mode == trial::HookMode::slide; });
    broken_again += slid != trial.samples.end();
    const auto [low, high] =
        std::minmax_element(stuck, slid, [](const auto& a, const auto& b) { return a.count < b.count; });
    smallest_rebound = std::min(smallest_rebound, high->count - low->count);
  }
  EXPECT_TRUE(proportion_below(0.07, stable, trials));
  EXPECT_TRUE(proportion_above(0.93, broken_again, trials));
  EXPECT_GE(smallest_rebound, 100) << "the spring lets the rotor back by hundreds of counts";
}

TEST(InitialConditions, FromSlidingTwoPhasesAreStable) {
  const std::int64_t trials = 200;
  const auto outcomes = outcomes_of(shipped_study("initial-conditions"), "from-sliding-two-phase", trials);
  EXPECT_TRUE(proportion_above(
      0.94, moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.stable; }), trials));
  EXPECT_TRUE(proportion_above(
      0.90,
      moves_with(outcomes,
                 [](const trial::MoveOutcome& move) { return move.outcome == trial::Outcome::zero_count; }),
      trials));
  EXPECT_TRUE(proportion_above(
      0.93, moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.phase_changes > 0; }),
      trials));
}

}  // namespace
}  // namespace zerocount::testing
