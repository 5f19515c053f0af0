// Trials of a real machine are compared with the simulated trials that do what the study asks.
#include "analysis/trials/summary/observed_comparison.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/point_accumulator.hpp"
#include "experiments/manifest/load_study.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/each_seed.hpp"

namespace zerocount::summary {
namespace {

/// A study with two moves a trial and one or two goals, on machines, in worlds or neither, and random
/// outcomes of its trials. Moves within the goal's band never end at zero counts.
struct ObservedTrials {
  static constexpr unsigned seeds = 60;

  explicit ObservedTrials(unsigned seed) : draws(seed) {
    std::string manifest =
        "zerocount: 1\nname: observed\nseed: 1\ntrials: 60\ncommand: {targets: [5, 0], hold: 0.2}\n"
        "sweep: {cases: {a: {}}}\nobserved: {a: {successes: 5, of: 6}}\n";
    manifest += draws.chance(0.5) ? "goal: {band: 3, within: 0.1, moves: 0.8}\n"
                                  : "goals: {first: {band: 3, within: 0.1, moves: 0.8, \"on\": [0]},"
                                    " second: {band: 3, within: 0.15, moves: 0.8, \"on\": [1]}}\n";
    if (draws.chance(0.5)) manifest += "machines: 6\n";
    study = manifest::parse_study(manifest, "test.yaml");
    const double reliable = draws.uniform(0.3, 0.95);
    for (std::int64_t trial = 0; trial < study.trials; ++trial) {
      std::vector<trial::MoveOutcome>& moves = trials.emplace_back(2);
      for (std::int64_t move = 0; move < 2; ++move) {
        trial::MoveOutcome& outcome = moves[static_cast<std::size_t>(move)];
        outcome.number = move;
        outcome.outcome = trial::Outcome::one_count;
        for (trial::BandOutcome& band : outcome.bands)
          band = {0.0, draws.chance(reliable) ? 0.05 : 0.19, 0.0};
      }
    }
  }

  bool succeeds(const std::vector<trial::MoveOutcome>& moves) const {
    const double second = study.goals.size() == 2 ? 0.15 : 0.1;
    const auto time = [&](std::size_t move) { return moves[move].bands[slot].settling_time; };
    return time(0) <= 0.1 && time(1) <= second;
  }

  measures::PointSummary summary() const {
    measures::PointAccumulator some(measures::move_kind(study), layout::measure_table(study.features));
    for (const std::vector<trial::MoveOutcome>& moves : trials) some.add({moves}, {});
    measures::PointAccumulator stored(measures::move_kind(study), layout::measure_table(study.features));
    const statistics::State state = some.state();
    stored.restore(state.whole, state.real, 2);
    return stored.statistics();
  }

  testing::Draws draws;
  study::Study study;
  /// Index of the goal's band of 3 counts among the bands that the trials measure, after those of 0 and 1
  /// count.
  std::size_t slot{2};
  std::vector<std::vector<trial::MoveOutcome>> trials;
};

TEST_EACH_SEED(ObservedTrials, AreComparedWithTrialsWhoseMovesAllMeetTheGoals) {
  const goal::Question question = goal::question_of(study);
  const study::ObservedCounts counts{draws.integer(0, 6), 6};
  const ObservedComparison found = compare_observed(question, summary(), counts);
  std::int64_t simulated = 0;
  std::vector<std::int64_t> of_machines(static_cast<std::size_t>(study.machines), 0);
  for (std::size_t trial = 0; trial < trials.size(); ++trial) {
    if (!succeeds(trials[trial])) continue;
    ++simulated;
    if (study.machines > 0) ++of_machines[trial % of_machines.size()];
  }
  EXPECT_EQ(found.simulated.successes, simulated);
  EXPECT_EQ(found.simulated.trials, 60);
  const statistics::Successes observed{counts.successes, counts.of};
  const statistics::ObservedTest expected = study.machines > 0
                                                ? statistics::machine_rank_test(observed, of_machines, 10)
                                                : statistics::fisher_test(observed, {simulated, 60});
  ASSERT_TRUE(found.test);
  EXPECT_DOUBLE_EQ(found.test->p, expected.p);
}

TEST_EACH_SEED(ObservedTrials, AreComparedWithZeroCountsWithoutAGoal) {
  study.goals.clear();
  study.machines = 0;
  for (std::vector<trial::MoveOutcome>& moves : trials)
    if (draws.chance(0.4))
      for (trial::MoveOutcome& move : moves) move.outcome = trial::Outcome::zero_count;
  const measures::PointSummary point = summary();
  const ObservedComparison found = compare_observed(goal::question_of(study), point, {3, 6});
  EXPECT_EQ(found.simulated.successes, point.outcomes.zero_count);
  EXPECT_EQ(found.test->p, statistics::fisher_test({3, 6}, {point.outcomes.zero_count, 60}).p);
}

}  // namespace
}  // namespace zerocount::summary
