// derivative: a derivative gain adds damping, as criterion (6) says, and chatters at the end of a move, as
// practical issue 5 of the paper warns.
#include <algorithm>
#include <string>
#include <vector>

#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t derivative_trials = 150;

std::int64_t stable_moves(const study::Study& study, const std::string& label) {
  return moves_with(outcomes_of(study, label, derivative_trials),
                    [](const trial::MoveOutcome& move) { return move.stable; });
}

/// All jerks of the first derivative_trials at a point.
std::vector<trial::Jerk> jerks_at(const study::Study& study, const std::string& label) {
  std::vector<trial::Jerk> jerks;
  for (std::int64_t index = 0; index < derivative_trials; ++index) {
    const WatchedTrial trial = watched(trial_of(study, label, index));
    jerks.insert(jerks.end(), trial.jerks.begin(), trial.jerks.end());
  }
  return jerks;
}

TEST(Derivative, AddsTheDampingThatCriterionSixAsksFor) {
  const study::Study study = shipped_study("derivative");
  EXPECT_TRUE(share_below(0.55, stable_moves(study, "b, controller.kd=0"), derivative_trials));
  EXPECT_TRUE(share_above(0.85, stable_moves(study, "b, controller.kd=0.0016"), derivative_trials));
  EXPECT_TRUE(share_above(0.95, stable_moves(study, "b, controller.kd=0.0032"), derivative_trials))
      << "(c + kd·T/Δx)·k1/J is above the gain";
}

TEST(Derivative, MakesMoreJerksOfASingleSample) {
  const study::Study study = shipped_study("derivative");
  const std::vector<trial::Jerk> without = jerks_at(study, "a, controller.kd=0");
  const std::vector<trial::Jerk> with = jerks_at(study, "a, controller.kd=0.0008");
  EXPECT_GT(with.size(), 3 * without.size() / 2);
  const auto single = [](const std::vector<trial::Jerk>& jerks) {
    return std::count_if(jerks.begin(), jerks.end(),
                         [](const trial::Jerk& jerk) { return jerk.duration < 0.75e-3; });
  };
  const auto count = [](const std::vector<trial::Jerk>& jerks) {
    return static_cast<std::int64_t>(jerks.size());
  };
  EXPECT_TRUE(share_below(0.3, single(without), count(without)));
  EXPECT_TRUE(share_above(0.7, single(with), count(with)));
}

TEST(Derivative, ChattersWhereItsKickLeavesTheCountOnTheOtherSide) {
  const study::Study study = shipped_study("derivative");
  const auto outcomes = outcomes_of(study, "a, controller.kd=0.0128", derivative_trials);
  EXPECT_TRUE(share_below(0.85, moves_with(outcomes, [](const auto& move) { return move.stable; }),
                          derivative_trials));
  const auto chatters = [](const trial::MoveOutcome& move) {
    return move.outcome == trial::Outcome::one_count;
  };
  EXPECT_TRUE(share_above(0.3, moves_with(outcomes, chatters), derivative_trials))
      << "by one count, for ever";
}

}  // namespace
}  // namespace zerocount::testing
