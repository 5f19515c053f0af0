#include "analysis/pairs/comparison/point_judgements.hpp"
#include "tests/support/test.hpp"

namespace zerocount::comparison {
namespace {

/// Made-up trials on machines that succeed with probabilities uniform between 0.4 and 1. A trial that fails
/// never arrives at its target.
PointTrials trials_on_machines(std::int64_t machines, std::int64_t trials, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  std::vector<double> chances(static_cast<std::size_t>(machines));
  for (double& chance : chances) chance = 0.4 + 0.6 * uniform(random);
  PointTrials all;
  all.trials = trials;
  all.moves = 1;
  all.machines = machines;
  for (std::int64_t trial = 0; trial < trials; ++trial) {
    const bool success = uniform(random) < chances[static_cast<std::size_t>(trial % machines)];
    all.values["success_rate"].push_back(success);
    all.values["arrival_rate"].push_back(success);
    all.values["stable_rate"].push_back(success);
    all.values["arrival_time"].push_back(success ? 0.03 : std::nan(""));
    all.values["jerk_count"].push_back(success ? 0.0 : 1.0);
  }
  return all;
}

/// Number of comparisons of two equal populations in which the p-value of the success rate is at most 5 %:
/// false alarms.
/// @param as_if_independent trials of one machine are taken for independent
int false_alarms(int comparisons, bool as_if_independent) {
  std::mt19937_64 random(5);
  int alarms = 0;
  for (int i = 0; i < comparisons; ++i) {
    PointTrials before = trials_on_machines(30, 600, random);
    PointTrials after = trials_on_machines(30, 600, random);
    if (as_if_independent) before.machines = after.machines = 0;
    alarms += compare_measures({}, "", {before, after, false}).front().p <= 0.05;
  }
  return alarms;
}

TEST(ComparisonOverMachines, KeepsItsFalseAlarmRateAlthoughTrialsOfAMachineAreDependent) {
  constexpr int comparisons = 300;
  EXPECT_LE(false_alarms(comparisons, false),
            0.05 * comparisons + 3.0 * std::sqrt(0.05 * 0.95 * comparisons));
  EXPECT_GT(false_alarms(comparisons, true), 0.12 * comparisons);
}

TEST(ComparisonOverMachines, FindsMachinesThatBeganToFail) {
  std::mt19937_64 random(6);
  const PointTrials before = trials_on_machines(60, 1200, random);
  PointTrials after = before;
  for (std::size_t trial = 0; trial < 1200; ++trial) {
    if (trial % 60 < 20) after.values["success_rate"][trial] = false;
  }
  const Judgement success = compare_measures({}, "", {before, after, true}).front();
  EXPECT_EQ(success.current_n, 60);  // machines
  EXPECT_LT(success.p, 1e-3);
  EXPECT_GT(success.effect, 0.15);
  EXPECT_TRUE(says(success.test, "over machines"));
}

TEST(ComparisonOverMachines, RequirementsHaveBoundsOverMachines) {
  std::mt19937_64 random(7);
  PointTrials trials = trials_on_machines(40, 4000, random);
  const RequirableQuantity success = find_requirable("success_rate").value();
  const Requirement requirement{.text = "", .quantity = success, .limit = {text::Relation::at_least, 0.6}};
  const Judgement over_machines = judge_requirement(requirement, trials, 0.95, 0.95);
  trials.machines = 0;
  const Judgement plain = judge_requirement(requirement, trials, 0.95, 0.95);
  EXPECT_EQ(over_machines.current, plain.current);
  EXPECT_GT(over_machines.current - over_machines.bounds.low, 2.0 * (plain.current - plain.bounds.low));
}

}  // namespace
}  // namespace zerocount::comparison
