// The batch engine against the reference, over random trials of every kind.
#include "tests/core/batch/bench_trials.hpp"
#include "tests/core/batch/expect_agreement.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

struct NamedKind {
  const char* name;
  TrialKind kind;
};

void PrintTo(const NamedKind& kind, std::ostream* out) {
  *out << kind.name;
}

class BatchEquality : public ::testing::TestWithParam<NamedKind> {};

INSTANTIATE_TEST_SUITE_P(
    Random, BatchEquality,
    ::testing::Values(NamedKind{"calm", TrialKind::calm}, NamedKind{"ringing", TrialKind::ringing},
                      NamedKind{"breaking_away", TrialKind::breaking_away},
                      NamedKind{"unlike_the_paper", TrialKind::unlike_the_paper},
                      NamedKind{"spring_alone", TrialKind::spring_alone},
                      NamedKind{"coulomb", TrialKind::coulomb}, NamedKind{"amplified", TrialKind::amplified},
                      NamedKind{"arriving", TrialKind::arriving},
                      NamedKind{"remembering", TrialKind::remembering},
                      NamedKind{"loaded", TrialKind::loaded}),
    [](const ::testing::TestParamInfo<NamedKind>& kind) { return std::string(kind.param.name); });

/// Random trials as they are: some run in lanes, and others go to the reference by themselves.
TEST_P(BatchEquality, OfRandomTrials) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 200; ++i) trials.push_back(random_trial(GetParam().kind, 20000 + i));
  expect_agreement(trials, GetParam().name);
}

TEST_P(BatchEquality, OfRandomTrialsThatRunInLanes) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 250; ++i) trials.push_back(trial_for_lanes(GetParam().kind, 30000 + i));
  expect_agreement_in_lanes(trials, GetParam().name);
}

TEST_P(BatchEquality, OfRandomTrialsWithAnyCreepExponent) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; trials.size() < 150; ++i) {
    const trial::TrialParameters trial = trial_with_any_exponent(GetParam().kind, 50000 + i);
    if (trial.friction.uniform.n != 2.0) trials.push_back(trial);
  }
  expect_agreement_in_lanes(trials, GetParam().name);
}

TEST_P(BatchEquality, TrialsThatDoNotRunInLanesAreTheReferencesToTheLastBit) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 100; ++i) {
    trials.push_back(random_trial(GetParam().kind, 40000 + i));
    if (i % 2 == 0)
      trials.back().disturbance.vibration = {{1e-4, 0.75 * trials.back().controller.sample_rate, 0.0}};
  }
  const std::vector<BatchedTrial> batched = run_batch(trials);
  int others = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (batch::runs_in_lanes(trials[i])) continue;
    ++others;
    EXPECT_EQ(difference_in_bits(batched[i], run_by_reference(trials[i])), "") << GetParam().name << i;
  }
  EXPECT_GE(others, 50);
}

/// Trials in which something happens at an awkward moment.
TEST(BatchEqualityInHardTrials, HoldsToo) {
  const std::vector<trial::TrialParameters> trials = {
      trial_for_lanes(TrialKind::arriving, 30208),  // a reversal in the sample that begins with another
      trial_for_lanes(TrialKind::arriving,
                      413654),  // a move ends as the last oscillation falls below rest, and a loop closes
  };
  for (const trial::TrialParameters& trial : trials) expect_agreement_in_lanes({trial}, "hard trial");
}

// The batch engine against the reference, over trials of the shipped workloads. What batch_equality does at
// length.

struct BenchManifest {
  const char* name;
  std::int64_t first;
  std::int64_t trials;
};

void PrintTo(const BenchManifest& manifest, std::ostream* out) {
  *out << manifest.name;
}

class WorkloadEquality : public ::testing::TestWithParam<BenchManifest> {
 protected:
  std::vector<trial::TrialParameters> trials() const {
    return bench_trials(GetParam().name, GetParam().first, GetParam().trials);
  }
};

INSTANTIATE_TEST_SUITE_P(Bench, WorkloadEquality,
                         ::testing::Values(BenchManifest{"bench-transient", 0, 2000},
                                           BenchManifest{"bench-creep", 0, 80},
                                           BenchManifest{"bench-marginal", 0, 600},
                                           BenchManifest{"bench-million", 999000, 1000}),
                         [](const ::testing::TestParamInfo<BenchManifest>& manifest) {
                           std::string name = manifest.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(WorkloadEquality, SampleBySample) {
  expect_agreement_in_lanes(trials(), GetParam().name);
}

/// Two among 100 000 whose ringing turns less than a nanosecond before a sampling instant: the step that is
/// left must not make those after it as short.
TEST(AReversalRightBeforeASample, IsFollowedAsByTheReference) {
  for (const std::int64_t index : {26759, 41027}) {
    expect_agreement_in_lanes(bench_trials("bench-creep", index, 1, {"trials=100000"}), "bench-creep");
  }
}

/// Behind couplings of all stiffnesses, over waits of a second: creep decelerates both masses, which the rest
/// rule must know. Where one engine came to rest later, θ differed by 3e-7 count.
TEST(ASecondMass, ComesToRestWithTheRotorAsInTheReference) {
  std::vector<trial::TrialParameters> trials = bench_trials("manifests/resonance", 0, 60);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    motion::LoadParameters& load = trials[i].plant.load;
    load.stiffness = 300.0 * std::pow(100.0, static_cast<double>(i) / 60.0);
    load.encoder = i % 2 == 0 ? motion::EncoderPlace::motor : motion::EncoderPlace::load;
  }
  const BatchAgreement agreement = expect_agreement_in_lanes(trials, "resonance");
  EXPECT_LT(agreement.theta, 3e-8);
  EXPECT_LT(agreement.slides, 20);
}

}  // namespace
}  // namespace zerocount::testing
