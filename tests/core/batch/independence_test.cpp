// What comes of a trial depends on its parameters alone, to the last bit: not on the number of lanes, the
// trials beside it, the instruction set, who watches, or what the engine ran before.
#include "tests/core/batch/batched_trials.hpp"
#include "tests/core/batch/bench_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

constexpr TrialKind kinds[] = {TrialKind::calm,         TrialKind::ringing,          TrialKind::breaking_away,
                               TrialKind::spring_alone, TrialKind::unlike_the_paper, TrialKind::arriving,
                               TrialKind::remembering,  TrialKind::coulomb,          TrialKind::amplified,
                               TrialKind::loaded};

/// Trials that have little in common: calm and ringing ones, creep, slides, other rigs, and some that lanes
/// do not run.
std::vector<trial::TrialParameters> different_trials() {
  std::vector<trial::TrialParameters> trials = bench_trials("bench-transient", 0, 60);
  const auto append = [&trials](const std::vector<trial::TrialParameters>& more) {
    trials.insert(trials.end(), more.begin(), more.end());
  };
  append(bench_trials("bench-marginal", 0, 60));
  append(bench_trials("bench-creep", 0, 20, {"command.hold=0.7"}));
  for (const TrialKind kind : kinds) {
    for (std::uint64_t i = 0; i < 15; ++i) trials.push_back(trial_for_lanes(kind, 50000 + i));
    for (std::uint64_t i = 0; i < 3; ++i) trials.push_back(random_trial(kind, 50000 + i));
    for (std::uint64_t i = 0; i < 3; ++i) {
      trials.push_back(trial_for_lanes(kind, 51000 + i));
      trials.back().encoder.fine_errors.noise = 0.3;
      trials.back().randomness.trial = i;
    }
  }
  return trials;
}

class BatchIndependence : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    trials = different_trials();
    expected = run_batch(trials);
  }

  static void expect_same(const std::vector<BatchedTrial>& results, const std::string& how) {
    ASSERT_EQ(results.size(), expected.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
      ASSERT_EQ(difference_in_bits(expected[i], results[i]), "") << "trial " << i << ", " << how;
    }
  }

  static inline std::vector<trial::TrialParameters> trials;
  static inline std::vector<BatchedTrial> expected;
};

TEST_F(BatchIndependence, OfTheNumberOfLanesAndTheInstructionSet) {
  for (const batch::InstructionSet instructions : available_instruction_sets()) {
    for (const int lanes : {1, 2, 7, 16, 33, 128}) {
      expect_same(run_batch(trials, {lanes, instructions}),
                  std::to_string(lanes) + " lanes, " + std::string(batch::name_of(instructions)));
    }
  }
}

TEST_F(BatchIndependence, OfTheOrder) {
  std::mt19937 random(5);
  for (int round = 0; round < 3; ++round) {
    std::vector<std::size_t> order(trials.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), random);
    std::vector<trial::TrialParameters> shuffled;
    shuffled.reserve(trials.size());
    for (const std::size_t i : order) shuffled.push_back(trials[i]);
    const std::vector<BatchedTrial> results = run_batch(shuffled);
    std::vector<BatchedTrial> sorted(trials.size());
    for (std::size_t i = 0; i < order.size(); ++i) sorted[order[i]] = results[i];
    expect_same(sorted, "shuffled");
  }
}

TEST_F(BatchIndependence, OfThereBeingOthers) {
  for (const batch::InstructionSet instructions : available_instruction_sets()) {
    std::vector<BatchedTrial> alone;
    alone.reserve(trials.size());
    for (const trial::TrialParameters& trial : trials) {
      alone.push_back(run_batch({trial}, {.instructions = instructions}).front());
    }
    expect_same(alone, "alone");
  }
}

/// Beside the same trial in all other lanes, and beside rigs that are nothing like it.
TEST_F(BatchIndependence, OfWhoTheOthersAre) {
  for (std::size_t i = 0; i < trials.size(); i += 11) {
    std::vector<trial::TrialParameters> twins(40, trials[i]);
    for (const BatchedTrial& twin : run_batch(twins)) {
      ASSERT_EQ(difference_in_bits(expected[i], twin), "") << "trial " << i << " among its twins";
    }
    std::vector<trial::TrialParameters> strangers;
    for (std::uint64_t j = 0; j < 31; ++j) {
      strangers.push_back(trial_for_lanes(TrialKind::unlike_the_paper, 60000 + 31 * i + j));
    }
    const std::size_t place = (7 * i) % strangers.size();
    strangers.insert(strangers.begin() + static_cast<std::ptrdiff_t>(place), trials[i]);
    ASSERT_EQ(difference_in_bits(expected[i], run_batch(strangers)[place]), "")
        << "trial " << i << " among strangers";
  }
}

TEST_F(BatchIndependence, OfWhetherSamplesAreObserved) {
  for (const batch::InstructionSet instructions : available_instruction_sets()) {
    expect_same(run_batch(trials, {.instructions = instructions}, Observed::jerks), "samples not observed");
  }
  batch::BatchEngine engine;
  std::vector<const trial::TrialParameters*> pointers;
  pointers.reserve(trials.size());
  for (const trial::TrialParameters& trial : trials) pointers.push_back(&trial);
  std::vector<trial::TrialOutcome> outcomes(trials.size());
  engine.run(pointers, outcomes);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    ASSERT_EQ(difference_in_bits({expected[i].outcome, {}, {}}, {outcomes[i], {}, {}}), "") << "trial " << i;
  }
}

TEST_F(BatchIndependence, OfWhatTheEngineRanBefore) {
  batch::BatchEngine engine({.lanes = 24});
  std::vector<trial::TrialParameters> wild;
  for (std::uint64_t i = 0; i < 100; ++i) wild.push_back(trial_for_lanes(kinds[i % 9], 61000 + i));
  run_batch(engine, wild);
  expect_same(run_batch(engine, trials), "after wild trials");
  run_batch(engine, {});
  expect_same(run_batch(engine, trials), "after themselves and none");
}

TEST(BatchObserversAre, ToldOfEachSampleInTheOrderOfTheTrial) {
  const std::vector<trial::TrialParameters> trials = different_trials();
  const std::vector<BatchedTrial> results = run_batch(trials);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    std::int64_t k = 0;
    for (const batch::BatchSample& sample : results[i].samples) {
      ASSERT_EQ(sample.trial, i);
      ASSERT_EQ(sample.k, k++);
    }
    EXPECT_EQ(k, trial::samples_of_trial(trials[i])) << i;
    std::int64_t jerks = 0;
    for (const trial::MoveOutcome& move : results[i].outcome.moves) jerks += move.jerk_count;
    EXPECT_EQ(static_cast<std::int64_t>(results[i].jerks.size()), jerks) << i;
  }
}

}  // namespace
}  // namespace zerocount::testing
