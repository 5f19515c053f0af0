// What comes of a trial depends on its parameters alone, to the last bit: not on the number of lanes, the
// trials beside it, the instruction set, who watches, or what the engine ran before.
#include "core/batch/batch.hpp"
#include "tests/core/batch/batch_agreement.hpp"
#include "tests/core/batch/batched_trials.hpp"
#include "tests/core/batch/bench_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

constexpr TrialKind kinds[] = {TrialKind::calm,         TrialKind::ringing,          TrialKind::breaking_away,
                               TrialKind::spring_alone, TrialKind::unlike_the_paper, TrialKind::arriving,
                               TrialKind::remembering,  TrialKind::coulomb,          TrialKind::amplified,
                               TrialKind::loaded};

/// Trials that have little in common: calm and ringing ones, creep, slides, other machines, and some that
/// lanes do not run.
std::vector<trial::TrialParameters> different_trials() {
  std::vector<trial::TrialParameters> trials = bench_trials("bench-transient", 0, 60);
  const auto append = [&trials](const std::vector<trial::TrialParameters>& more) {
    trials.insert(trials.end(), more.begin(), more.end());
  };
  append(bench_trials("bench-marginal", 0, 60));
  append(bench_trials("bench-creep", 0, 20, {"command.hold=0.7"}));
  for (const TrialKind kind : kinds) {
    for (std::uint64_t i = 0; i < 15; ++i) trials.push_back(trial_for_lanes(kind, 50000 + i));
    for (std::uint64_t i = 0; i < 2; ++i)
      trials.push_back(with_all_measures(trial_for_lanes(kind, 52000 + i)));
    for (std::uint64_t i = 0; i < 3; ++i) trials.push_back(random_trial(kind, 50000 + i));
    for (std::uint64_t i = 0; i < 3; ++i) {
      trials.push_back(trial_for_lanes(kind, 51000 + i));
      trials.back().encoder.fine_errors.noise = 0.3;
      trials.back().randomness.trial = i;
    }
  }
  return trials;
}

/// A value of any type. The conversion adds the size of the type.
struct AnyMember {
  std::size_t& size;
  template <class Member>
  operator Member() const {
    size += sizeof(Member);
    return {};
  }
};

/// Size of all members of an aggregate together, without padding, in bytes.
template <class Record, class... Members>
std::size_t size_of_members(std::size_t& size, Members... members) {
  if constexpr (requires { Record{members..., AnyMember{size}}; }) {
    return size_of_members<Record>(size, members..., AnyMember{size});
  } else {
    static_cast<void>(Record{members...});
    return size;
  }
}

/// Number of bytes of a record whose change is seen.
/// @param differ whether two records are seen to differ.
template <class Record, class Differ>
std::size_t seen_bytes(Differ differ) {
  std::size_t seen = 0;
  for (std::size_t i = 0; i < sizeof(Record); ++i) {
    std::array<unsigned char, sizeof(Record)> bytes{};
    const auto zero = std::bit_cast<Record>(bytes);
    bytes[i] = 1;
    if (differ(zero, std::bit_cast<Record>(bytes))) ++seen;
  }
  return seen;
}

// The tests of the batch engine rest on this comparison. A new member of an outcome must be a measure of the
// table, or be compared beside it.
TEST(DifferenceInBits, SeesEachMember) {
  const auto moves_differ = [](const trial::MoveOutcome& a, const trial::MoveOutcome& b) {
    return !difference_in_bits({{{a}}, {}, {}}, {{{b}}, {}, {}}).empty();
  };
  std::size_t size = 0;
  EXPECT_EQ(seen_bytes<trial::MoveOutcome>(moves_differ), size_of_members<trial::MoveOutcome>(size));
  const auto jerks_differ = [](const trial::Jerk& a, const trial::Jerk& b) {
    return !difference_in_bits({{}, {a}, {}}, {{}, {b}, {}}).empty();
  };
  size = 0;
  EXPECT_EQ(seen_bytes<trial::Jerk>(jerks_differ), size_of_members<trial::Jerk>(size));
}

class BatchIndependence : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    trials = different_trials();
    expected = run_batch(trials);
  }

  static void expect_same(const std::vector<BatchedTrial>& results, const std::string& how) {
    ASSERT_EQ(results.size(), expected.size());
    for (std::size_t i = 0; i < results.size(); ++i)
      ASSERT_EQ(difference_in_bits(expected[i], results[i]), "") << "trial " << i << ", " << how;
  }

  static inline std::vector<trial::TrialParameters> trials;
  static inline std::vector<BatchedTrial> expected;
};

TEST_F(BatchIndependence, ResultsDoNotDependOnLanesOrInstructionSet) {
  for (const batch::InstructionSet instructions : available_instruction_sets()) {
    for (const int lanes : {1, 2, 7, 16, 33, 128}) {
      expect_same(run_batch(trials, {lanes, instructions}),
                  std::to_string(lanes) + " lanes, " + std::string(batch::name_of(instructions)));
    }
  }
}

TEST_F(BatchIndependence, ResultsDoNotDependOnTheOrderOfTrials) {
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

TEST_F(BatchIndependence, ATrialAloneEqualsTheTrialInABatch) {
  for (const batch::InstructionSet instructions : available_instruction_sets()) {
    std::vector<BatchedTrial> alone;
    alone.reserve(trials.size());
    for (const trial::TrialParameters& trial : trials)
      alone.push_back(run_batch({trial}, {.instructions = instructions}).front());
    expect_same(alone, "alone");
  }
}

/// A trial gives the same results beside the same trial in all other lanes, and beside very different
/// machines.
TEST_F(BatchIndependence, ResultsDoNotDependOnTheOtherTrials) {
  for (std::size_t i = 0; i < trials.size(); i += 11) {
    std::vector<trial::TrialParameters> twins(40, trials[i]);
    for (const BatchedTrial& twin : run_batch(twins))
      ASSERT_EQ(difference_in_bits(expected[i], twin), "") << "trial " << i << " among its twins";
    std::vector<trial::TrialParameters> strangers;
    for (std::uint64_t j = 0; j < 31; ++j)
      strangers.push_back(trial_for_lanes(TrialKind::unlike_the_paper, 60000 + 31 * i + j));
    const std::size_t place = (7 * i) % strangers.size();
    strangers.insert(strangers.begin() + static_cast<std::ptrdiff_t>(place), trials[i]);
    ASSERT_EQ(difference_in_bits(expected[i], run_batch(strangers)[place]), "")
        << "trial " << i << " among strangers";
  }
}

TEST_F(BatchIndependence, ObservingSamplesChangesNoResult) {
  for (const batch::InstructionSet instructions : available_instruction_sets())
    expect_same(run_batch(trials, {.instructions = instructions}, Observed::jerks), "samples not observed");
  batch::BatchEngine engine;
  std::vector<const trial::TrialParameters*> pointers;
  pointers.reserve(trials.size());
  for (const trial::TrialParameters& trial : trials) pointers.push_back(&trial);
  std::vector<trial::TrialOutcome> outcomes(trials.size());
  engine.run(pointers, outcomes);
  for (std::size_t i = 0; i < trials.size(); ++i)
    ASSERT_EQ(difference_in_bits({expected[i].outcome, {}, {}}, {outcomes[i], {}, {}}), "") << "trial " << i;
}

TEST_F(BatchIndependence, EarlierRunsOfTheEngineChangeNoResult) {
  batch::BatchEngine engine({.lanes = 24});
  std::vector<trial::TrialParameters> wild;
  for (std::uint64_t i = 0; i < 100; ++i) wild.push_back(trial_for_lanes(kinds[i % 9], 61000 + i));
  run_batch(engine, wild);
  expect_same(run_batch(engine, trials), "after wild trials");
  run_batch(engine, {});
  expect_same(run_batch(engine, trials), "after themselves and none");
}

TEST(BatchObservers, SeeEachSampleInTheOrderOfTheTrial) {
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

// Lanes run the trials that they support; every parameter that excludes a trial is found.

struct Change {
  const char* what;
  std::function<void(trial::TrialParameters&)> make;
};

trial::TrialParameters plain_trial() {
  return bench_trials("bench-transient", 0, 1).front();
}

TEST(RunsInLanes, UnsupportedTrialsRunOnTheReference) {
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
  for (std::size_t i = 0; i < trials.size(); ++i)
    EXPECT_EQ(difference_in_bits(batched[i], run_by_reference(trials[i])), "") << changes[i].what;
}

TEST(InstructionSets, ThePortableOneIsAlwaysAvailable) {
  const std::vector<batch::InstructionSet> sets = available_instruction_sets();
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets.front(), batch::InstructionSet::portable);
  EXPECT_EQ(sets.back(), batch::widest_instruction_set());
  EXPECT_EQ(batch::BatchSettings{}.instructions, batch::widest_instruction_set());
}

TEST(InstructionSets, HaveDifferentNames) {
  std::set<std::string_view> names;
  for (const batch::InstructionSet set :
       {batch::InstructionSet::portable, batch::InstructionSet::avx2, batch::InstructionSet::avx512}) {
    names.insert(batch::name_of(set));
  }
  EXPECT_EQ(names.size(), 3U);
}

// verdict.stop in the lanes: trials end at the same sample as in the reference, and like it.

TEST(BatchEarlyDecision, StopsATrialAtTheSampleOfTheReference) {
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
TEST(BatchEarlyDecision, LeavesNoStateForTheNextTrialOfTheLane) {
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

TEST(BatchNonfiniteMotion, IsDetectedAsByTheReference) {
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

TEST(BatchNonfiniteMotion, ChangesNoOtherTrial) {
  const std::vector<trial::TrialParameters> sound = bench_trials("bench-marginal", 0, 40);
  const std::vector<BatchedTrial> expected = run_batch(sound);
  std::vector<trial::TrialParameters> mixed = sound;
  for (const LostTrial& trial : lost_trials()) mixed.insert(mixed.begin() + 7, trial.parameters);
  const std::vector<BatchedTrial> results = run_batch(mixed, {.lanes = 16});
  const std::size_t lost = mixed.size() - sound.size();
  for (std::size_t i = 0; i < sound.size(); ++i)
    EXPECT_EQ(difference_in_bits(expected[i], results[i < 7 ? i : i + lost]), "") << i;
}

}  // namespace
}  // namespace zerocount::testing
