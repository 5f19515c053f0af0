// The batch engine against the reference, over random trials of every kind.
#include "core/loop/encoder.hpp"
#include "tests/core/batch/batch_agreement.hpp"
#include "tests/core/batch/batched_trials.hpp"
#include "tests/core/batch/bench_trials.hpp"
#include "tests/core/loop/random_blocks.hpp"
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
TEST_P(BatchEquality, RandomTrialsEqualTheReference) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 200; ++i) trials.push_back(random_trial(GetParam().kind, 20000 + i));
  expect_agreement(trials, GetParam().name);
}

TEST_P(BatchEquality, RandomTrialsInLanesEqualTheReference) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 250; ++i) trials.push_back(trial_for_lanes(GetParam().kind, 30000 + i));
  expect_agreement_in_lanes(trials, GetParam().name);
}

TEST_P(BatchEquality, AllMeasuresOfTrialsInLanesEqualTheReference) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 60; ++i)
    trials.push_back(with_all_measures(trial_for_lanes(GetParam().kind, 80000 + i)));
  expect_agreement_in_lanes(trials, GetParam().name);
}

TEST_P(BatchEquality, TrialsWithAnyCreepExponentEqualTheReference) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; trials.size() < 150; ++i) {
    const trial::TrialParameters trial = trial_with_any_exponent(GetParam().kind, 50000 + i);
    if (trial.friction.uniform.n != 2.0) trials.push_back(trial);
  }
  expect_agreement_in_lanes(trials, GetParam().name);
}

TEST_P(BatchEquality, TrialsOutsideLanesEqualTheReferenceBitForBit) {
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
TEST(BatchEqualityInHardTrials, TrialsWithCoincidingEventsEqualTheReference) {
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

TEST_P(WorkloadEquality, AgreesSampleBySample) {
  expect_agreement_in_lanes(trials(), GetParam().name);
}

/// Two of 100 000 trials whose ringing reverses less than a nanosecond before a sampling instant. The tiny
/// remaining step must not make the following steps as short.
TEST(ReversalJustBeforeASample, EqualsTheReference) {
  for (const std::int64_t index : {26759, 41027})
    expect_agreement_in_lanes(bench_trials("bench-creep", index, 1, {"trials=100000"}), "bench-creep");
}

/// Behind couplings of all stiffnesses, over waits of a second: creep decelerates both masses, which the rest
/// rule must know. Where one engine came to rest later, θ differed by 3e-7 count.
TEST(SecondMassInLanes, ComesToRestAsInTheReference) {
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

/// The counts before the first sample are extrapolated with the initial velocity, for the difference of
/// counts, its filter and the observer.
TEST(StartInMotion, EqualsTheReference) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 200; ++i) {
    trial::TrialParameters p = trial_for_lanes(TrialKind::calm, 90000 + i);
    RandomBlocks draw(i);
    constexpr BlockKind kinds[]{BlockKind::none, BlockKind::derivative, BlockKind::observer,
                                BlockKind::cascade};
    p.controller.blocks = draw.blocks(kinds[i % std::size(kinds)], p.controller.sample_rate);
    p.controller.blocks.derivative_window = 1;
    p.controller.kd = draw.log_uniform(1e-5, 1e-3);
    p.initial.velocity =
        draw.uniform(-30.0, 30.0) * loop::fine_resolution(p.encoder) * p.controller.sample_rate;
    trials.push_back(p);
  }
  expect_agreement(trials, "starts in motion");
}

/// The integral holds the part of the load that the contact cannot carry, through delay, amplifier, late
/// samples and blocks.
TEST(StartUnderHoldingTorque, RunsInLanesAsInTheReference) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 120; ++i) {
    trial::TrialParameters p = trial_for_lanes(TrialKind::loaded, 91000 + i);
    RandomBlocks draw(i);
    p.initial = {.encoder_phase = 0.5, .holding = true};
    p.friction.model = i % 2 == 0 ? friction::FrictionModel::none : friction::FrictionModel::coulomb;
    const double sign = i % 3 == 0 ? -1.0 : 1.0;
    p.disturbance = {.torque = sign * draw.uniform(1.1, 3.0) * p.friction.uniform.breakaway};
    p.dac = {.bits = 20, .resolution = 8.0 * p.friction.uniform.breakaway / (1 << 20)};
    p.controller.delay = static_cast<double>(i % 4);
    if (i % 5 == 0) p.amplifier.bandwidth = draw.uniform(50.0, 300.0);
    if (i % 8 == 0) p.controller.jitter = 0.3 / p.controller.sample_rate;
    if (i % 7 == 0) p.controller.blocks.observer = {.bandwidth = 20.0, .inertia = p.plant.inertia};
    if (i % 7 == 1) p.controller.blocks.filters = {{.frequency = 0.1 * p.controller.sample_rate}};
    p.command.hold = 150.0 / p.controller.sample_rate;
    trials.push_back(p);
  }
  const std::vector<BatchedTrial> batched = run_batch(trials);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    ASSERT_TRUE(batch::runs_in_lanes(trials[i])) << i;
    const BatchedTrial reference = run_by_reference(trials[i]);
    const double resolution = loop::fine_resolution(trials[i].encoder);
    ASSERT_GT(reference.samples.size(), 100u);
    // A fall would be of thousands of counts; the law answers to the count that the start rounds away.
    for (std::size_t k = 0; k < 100; ++k) {
      ASSERT_EQ(batched[i].samples[k].code, reference.samples[k].code) << i << ", sample " << k;
      ASSERT_NEAR(batched[i].samples[k].theta, reference.samples[k].theta, 1e-3 * resolution) << i;
    }
  }
}

// The batch engine against the reference under the laws that have no hook: an air bearing, Coulomb's, Dahl's,
// LuGre's and the generalised Maxwell-slip model.

struct LawCase {
  friction::FrictionModel model;
  const char* name;
};

void PrintTo(const LawCase& law, std::ostream* out) {
  *out << law.name;
}

class LawsWithoutHook : public ::testing::TestWithParam<LawCase> {};

INSTANTIATE_TEST_SUITE_P(Random, LawsWithoutHook,
                         ::testing::Values(LawCase{friction::FrictionModel::none, "none"},
                                           LawCase{friction::FrictionModel::coulomb, "coulomb"},
                                           LawCase{friction::FrictionModel::dahl, "dahl"},
                                           LawCase{friction::FrictionModel::lugre, "lugre"},
                                           LawCase{friction::FrictionModel::gms, "gms"}),
                         [](const ::testing::TestParamInfo<LawCase>& law) {
                           return std::string(law.param.name);
                         });

constexpr TrialKind kinds_under_laws[] = {TrialKind::calm,          TrialKind::ringing,
                                          TrialKind::breaking_away, TrialKind::unlike_the_paper,
                                          TrialKind::arriving,      TrialKind::loaded};

/// Random Maxwell-slip elements, up to sixteen, which together are about as stiff as the spring.
std::vector<friction::GmsElement> random_elements(const friction::FrictionParameters& f,
                                                  std::uint64_t index) {
  RandomBlocks draw(index);
  std::vector<friction::GmsElement> elements(index % 20 == 0 ? 16 : 1 + index % 5);
  double weights = 0.0;
  for (friction::GmsElement& element : elements) {
    element = {(f.k1 + f.k2) * draw.log_uniform(0.1, 1.0) / static_cast<double>(elements.size()),
               draw.log_uniform(1e-3, 1.0)};
    weights += element.weight;
  }
  for (friction::GmsElement& element : elements) element.weight /= weights;
  return elements;
}

/// A random trial under this law, with bristles about as stiff and as damped as its spring and its contact.
trial::TrialParameters trial_under(friction::FrictionModel model, TrialKind kind, std::uint64_t index) {
  trial::TrialParameters p = random_trial(kind, index);
  p.amplifier = {};
  p.friction.model = model;
  // Without friction the lanes know delays of whole samples.
  if (model == friction::FrictionModel::none) p.controller.delay = std::round(p.controller.delay);
  friction::FrictionParameters& f = p.friction.uniform;
  f.sigma0 = f.k1 + static_cast<double>(index % 5) * 0.25 * f.k2;
  f.sigma1 = index % 4 == 0 ? 0.0 : 0.4 * static_cast<double>(index % 4) * p.plant.presliding_damping;
  f.gms_attraction = 0.1 * std::pow(10.0, static_cast<double>(index % 5));
  if (index % 2 == 0) p.friction.gms_elements = random_elements(f, index);
  return p;
}

std::vector<trial::TrialParameters> trials_under(friction::FrictionModel model, std::uint64_t each) {
  std::vector<trial::TrialParameters> trials;
  for (const TrialKind kind : kinds_under_laws) {
    for (std::uint64_t i = 0; i < each; ++i) trials.push_back(trial_under(model, kind, 70000 + i));
  }
  return trials;
}

/// Agreement of the samples of a trial by the two engines, up to the first sample at which count or code
/// differ.
struct SampleAgreement {
  bool parts{false};  ///< there is a sample at which count or code differ
  /// Largest difference of the rotor angle θ up to that sample, divided by the promised 1e-6 count plus 1e-9
  /// of the travel.
  double difference{0.0};
};

SampleAgreement agreement_of_samples(const BatchedTrial& one, const BatchedTrial& other, double resolution) {
  SampleAgreement agreement;
  double travel = 0.0;
  for (std::size_t k = 0; k < other.samples.size(); ++k) {
    const batch::BatchSample& a = one.samples[k];
    const batch::BatchSample& b = other.samples[k];
    if (k > 0) travel += std::abs(b.theta - other.samples[k - 1].theta) / resolution;
    const double allowed = 1e-6 + 1e-9 * travel;
    agreement.difference = std::max(agreement.difference, std::abs(a.theta - b.theta) / resolution / allowed);
    agreement.parts = a.count != b.count || a.code != b.code;
    if (agreement.parts) break;
  }
  return agreement;
}

// Counts, codes and measures are the same. A trial parts where θ is on the edge of a count to within that
// accuracy.
TEST_P(LawsWithoutHook, AgreeSampleBySample) {
  // The reference takes long for many elements.
  const std::uint64_t each = GetParam().model == friction::FrictionModel::gms ? 20 : 60;
  const std::vector<trial::TrialParameters> trials = trials_under(GetParam().model, each);
  const std::vector<BatchedTrial> batched = run_batch(trials);
  int slid = 0;
  int parted = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    ASSERT_TRUE(batch::runs_in_lanes(trials[i])) << i;
    const BatchedTrial reference = run_by_reference(trials[i]);
    ASSERT_EQ(batched[i].samples.size(), reference.samples.size()) << i;
    const SampleAgreement agreement =
        agreement_of_samples(batched[i], reference, loop::fine_resolution(trials[i].encoder));
    EXPECT_LT(agreement.difference, 1.0) << i;
    parted += agreement.parts ? 1 : 0;
    ASSERT_EQ(batched[i].outcome.moves.size(), reference.outcome.moves.size()) << i;
    for (std::size_t m = 0; m < reference.outcome.moves.size() && !agreement.parts; ++m) {
      const trial::MoveOutcome& one = batched[i].outcome.moves[m];
      const trial::MoveOutcome& other = reference.outcome.moves[m];
      EXPECT_EQ(one.outcome, other.outcome) << i;
      EXPECT_EQ(one.arrival, other.arrival) << i;
      EXPECT_EQ(one.jerk_count, other.jerk_count) << i;
      EXPECT_EQ(one.broke_away, other.broke_away) << i;
      EXPECT_EQ(one.reversal_depth, 0) << i;
      slid += one.broke_away ? 1 : 0;
    }
  }
  EXPECT_LE(parted, each < 60 ? 1 : 3);
  EXPECT_EQ(slid > 20, GetParam().model != friction::FrictionModel::none);
}

// Beside trials with a hook, on any instruction set and any number of lanes, to the last bit.
TEST_P(LawsWithoutHook, DoNotDependOnTheirNeighbours) {
  std::vector<trial::TrialParameters> trials = trials_under(GetParam().model, 12);
  const std::vector<BatchedTrial> alone = run_batch(trials);
  std::vector<trial::TrialParameters> mixed;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    mixed.push_back(trials[i]);
    mixed.push_back(random_trial(kinds_under_laws[i % 3], 80000 + i));
  }
  for (const batch::InstructionSet instructions : available_instruction_sets()) {
    for (const int lanes : {7, 128}) {
      const std::vector<BatchedTrial> among =
          run_batch(mixed, {.lanes = lanes, .instructions = instructions});
      for (std::size_t i = 0; i < trials.size(); ++i)
        ASSERT_EQ(difference_in_bits(among[2 * i], alone[i]), "") << i << " of " << lanes;
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
