// repeatability: what ISO 230-2 says of axes with and without an integral. With it they repeat to the count,
// once creep is over; a move that is looked at before may be caught in a jerk. Without it they stop short of
// the target from either side.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "analysis/trials/iso230/repeatability.hpp"
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

/// One axis of the repeatability study, with the moves that it made.
struct MeasuredAxis {
  trial::TrialParameters parameters;
  std::vector<trial::MoveOutcome> moves;
  iso230::TrialRepeatability repeatability;
};

MeasuredAxis measured_axis(const study::Study& study, const std::string& label, std::int64_t index) {
  const trial::TrialParameters parameters = trial_of(study, label, index);
  std::vector<trial::MoveOutcome> moves = trial::run_trial(parameters).moves;
  const auto repeatability = iso230::trial_repeatability(study.sequence, parameters, moves);
  if (!repeatability) throw std::runtime_error("the motion of an axis was lost");
  return {parameters, std::move(moves), *repeatability};
}

double count_of(const trial::TrialParameters& parameters) {
  return 2.0 * std::numbers::pi / parameters.encoder.fine;  // rad
}

// "100% repeatability of precision" (paper, section 3) where the hold lets the contact harden: 12 s is six
// times 1/α. Two cycles do, to keep it short.
TEST(RepeatabilityStudy, TwoPhaseControlRepeatsToTheCountOnceCreepIsOver) {
  const study::Study study = shipped_study("repeatability", {"command.hold=12", "command.sequence.cycles=2"});
  std::int64_t approaches = 0, exact = 0, axes = 0, repeating = 0;
  for (std::int64_t index = 0; index < 16; ++index) {
    const MeasuredAxis axis = measured_axis(study, "two-phase", index);
    for (std::size_t move = 0; move < study.sequence.size(); ++move) {
      if (study.sequence[move].target < 0) continue;
      ++approaches;
      exact += axis.moves[move].final_error == 0;
    }
    const iso230::AxisRepeatability& encoder = axis.repeatability.from_encoder.axis;
    ++axes;
    repeating += encoder.repeatability == 0.0 && encoder.accuracy == 0.0 && encoder.reversal == 0.0;
    // By the true position an axis repeats to the width of the count in which it is held.
    EXPECT_LT(axis.repeatability.from_position.axis.systematic, count_of(axis.parameters));
  }
  EXPECT_TRUE(proportion_above(0.97, exact, approaches));
  EXPECT_TRUE(proportion_above(0.60, repeating, axes));
}

// After 3 s creep still goes on, and some moves end in the middle of a jerk: one count beyond the target, the
// way that the holding torque pushes. One such move in fifty is enough for an axis not to repeat to the
// count.
TEST(RepeatabilityStudy, AMoveThatEndsWhileItCreepsIsAtMostAJerkAway) {
  const study::Study study = shipped_study("repeatability", {"command.hold=3"});
  std::int64_t approaches = 0, missed = 0, arrived = 0;
  for (std::int64_t index = 0; index < 16; ++index) {
    const MeasuredAxis axis = measured_axis(study, "two-phase", index);
    bool all_exact = true;
    for (std::size_t move = 0; move < study.sequence.size(); ++move) {
      if (study.sequence[move].target < 0) continue;
      const trial::MoveOutcome& outcome = axis.moves[move];
      ++approaches;
      arrived += outcome.arrived && outcome.stable;
      if (outcome.final_error == 0) continue;
      ++missed;
      all_exact = false;
      EXPECT_EQ(std::abs(outcome.final_error), 1);
      EXPECT_GT(outcome.jerk_count, 0);
      EXPECT_EQ(outcome.final_error<0, outcome.holding_torque> 0.0) << "pushed on by its torque";
    }
    EXPECT_EQ(all_exact, axis.repeatability.from_encoder.axis.accuracy == 0.0);
  }
  EXPECT_TRUE(proportion_above(0.98, arrived, approaches));
  EXPECT_TRUE(proportion_below(0.03, missed, approaches));
  EXPECT_GT(missed, 0) << "this is what the test is about";
}

TEST(RepeatabilityStudy, WithoutAnIntegralTheAxisStopsShortFromEitherSide) {
  const study::Study study = shipped_study("repeatability", {"command.sequence.cycles=2"});
  std::int64_t approaches = 0, short_of_target = 0, axes = 0, repeating = 0;
  for (std::int64_t index = 0; index < 12; ++index) {
    const MeasuredAxis axis = measured_axis(study, "pd-alone", index);
    ++axes;
    repeating += axis.repeatability.from_encoder.axis.repeatability == 0.0;
    for (std::size_t move = 0; move < study.sequence.size(); ++move) {
      if (study.sequence[move].target < 0) continue;
      ++approaches;
      short_of_target += axis.moves[move].final_error * study.sequence[move].direction > 10;
    }
  }
  EXPECT_TRUE(proportion_above(0.97, short_of_target, approaches));
  EXPECT_TRUE(proportion_below(0.45, repeating, axes));
}

// The reversal value is what the two stall errors make together, and almost all of the bidirectional
// repeatability.
TEST(RepeatabilityStudy, ReversalValueIsTheSumOfTheStallErrors) {
  const study::Study study = shipped_study("repeatability", {"command.sequence.cycles=2"});
  for (std::int64_t index = 0; index < 6; ++index) {
    const MeasuredAxis axis = measured_axis(study, "pd-alone", index);
    double largest = 0.0;
    for (std::size_t target = 0; target < axis.repeatability.from_encoder.targets.size(); ++target) {
      double up = 0.0, down = 0.0;
      int ups = 0, downs = 0;
      for (std::size_t move = 0; move < study.sequence.size(); ++move) {
        if (study.sequence[move].target != static_cast<std::int64_t>(target)) continue;
        const auto short_of = static_cast<double>(std::abs(axis.moves[move].final_error));
        const bool from_below = study.sequence[move].direction > 0;
        (from_below ? up : down) += short_of;
        ++(from_below ? ups : downs);
      }
      const double stalls = up / ups + down / downs;
      const iso230::TargetRepeatability& encoder = axis.repeatability.from_encoder.targets[target];
      const iso230::TargetRepeatability& position = axis.repeatability.from_position.targets[target];
      EXPECT_NEAR(encoder.reversal, -stalls, 1e-9) << "x̄↑ − x̄↓, counts";
      EXPECT_NEAR(position.reversal / count_of(axis.parameters), encoder.reversal, 1.0) << "to the count";
      EXPECT_GE(encoder.repeatability, std::abs(encoder.reversal));
      EXPECT_LE(encoder.repeatability,
                std::abs(encoder.reversal) + encoder.repeatability_positive + encoder.repeatability_negative);
      largest = std::max(largest, std::abs(encoder.reversal));
    }
    EXPECT_EQ(axis.repeatability.from_encoder.axis.reversal, largest);
    EXPECT_GE(axis.repeatability.from_encoder.axis.repeatability, largest);
  }
}

// Studies in which everything is random that can be while a trial runs: the same datasets for any number of
// threads, for parts in any order and after any interruption, and every trial again from its number alone.

namespace fs = std::filesystem;

/// The keys that both studies have: instruments with noise and losses, and a random history.
const char* const instruments =
    "encoder:\n"
    "  fine_errors: {noise: {uniform: [0, 0.3]}, missed: 2.0e-3, eccentricity: 1.0e-4,\n"
    "                eccentricity_angle: {uniform: [0, 6]}, interpolation: {uniform: [0, 0.3]}}\n"
    "  coarse_errors: {noise: 0.1, missed: {log_uniform: [1.0e-4, 1.0e-2]}}\n"
    "dac: {noise: {uniform: [0, 2.0e-4]}, offset: {normal: {mean: 0, sd: 1.0e-4}},\n"
    "      gain_error: {uniform: [-0.02, 0.02]}, nonlinearity: {uniform: [0, 2]}}\n"
    "amplifier: {bandwidth: {uniform: [300, 900]}}\n"
    "friction:\n"
    "  k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.2}}\n"
    "  breakaway: {profile: {mean: 0.3, cv: 0.1, correlation_length: 0.2}}\n"
    "  alpha: {log_uniform: [0.2, 2.0]}\n"
    "retain: {trials: [1, 3]}\n";

std::string closed_loop(int trials) {
  return "zerocount: 1\nname: all of a closed loop\nseed: 31\nindependent_points: true\n"
         "trials: " +
         std::to_string(trials) + "\n" + instruments +
         "controller: {ki: 2.0e-5, coarse: {coarse_beyond: 300, kd: {uniform: [5.0e-3, 7.0e-3]}}}\n"
         "command:\n"
         "  sequence: {targets: [{integers: [-900, -800]}, 1500], cycles: 1, overrun: {integers: [300, "
         "400]}}\n"
         "  hold: 0.15\n"
         "  profile: {shape: s_curve, velocity_limit: {uniform: [1, 2]}}\n"
         "initial:\n"
         "  encoder_phase: {uniform: [0, 1]}\n"
         "  position: {uniform: [0, 6.283185307179586]}\n"
         "  history: {reversals: {integers: [1, 9]}, torque: {uniform: [0.02, 0.15]}}\n"
         "  integral: {uniform: [-0.02, 0.02]}\n"
         "verdict: {dwell: 0.02, window: 0.02}\n"
         "sweep:\n"
         "  cases:\n"
         "    stuck: {}\n"
         "    sliding: {initial.mode: slide, initial.velocity: {log_uniform: [1.0e-3, 0.1]}}\n";
}

std::string open_loop(int trials) {
  return "zerocount: 1\nname: all of an open loop\nseed: 32\ntrials: " + std::to_string(trials) + "\n" +
         instruments +
         "command:\n"
         "  torque: {levels: [{uniform: [0.05, 0.15]}, 0, {triangular: [-0.1, 0, 0.1]}], rate: {uniform: [2, "
         "5]}}\n"
         "  hold: 0.2\n"
         "initial: {history: {reversals: 4, torque: {uniform: [0.05, 0.15]}}, velocity: {uniform: [-0.05, "
         "0.05]}}\n"
         "sweep: {cases: {creeping: {}, elastic: {friction.model: spring}}}\n";
}

struct RandomStudy {
  const char* name;
  std::string (*manifest)(int trials);
  int trials;  ///< number of trials, chosen so that a run takes about a quarter of a second
};

void PrintTo(const RandomStudy& study, std::ostream* out) {
  *out << study.name;
}

class StudyDeterminism : public ::testing::TestWithParam<RandomStudy> {
 protected:
  void write(int trials) { folder_.write("study.yaml", GetParam().manifest(trials)); }
  ProgramResult run(const std::vector<std::string>& words) const {
    return zerocount_program(words, folder_.path());
  }
  void complete(const std::string& output, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"run", "study.yaml", "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = run(words);
    ASSERT_EQ(result.code, 0) << result.err;
  }
  TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Random, StudyDeterminism,
                         ::testing::Values(RandomStudy{"closed loop", closed_loop, 30},
                                           RandomStudy{"open loop", open_loop, 50}));

TEST_P(StudyDeterminism, DatasetsDoNotDependOnThreadsPartsOrTheirOrder) {
  write(16);
  complete("whole.h5", {"--threads", "1"});
  for (const char* part : {"1/3", "2/3", "3/3"})
    complete(std::string("part") + part[0] + ".h5", {"--threads", "3", "--shard", part});
  ASSERT_EQ(run({"merge", "part2.h5", "part3.h5", "part1.h5", "-o", "merged.h5"}).code, 0);
  expect_same_datasets(folder_ / "whole.h5", folder_ / "merged.h5");
}

TEST_P(StudyDeterminism, AReplayedTrialEqualsTheRecordedOne) {
  write(5);
  complete("out.h5");
  for (const char* point : {"0", "1"}) {
    for (const char* trial : {"0", "4"}) {
      const ProgramResult replay = run({"trace", "out.h5", "--point", point, "--trial", trial});
      EXPECT_EQ(replay.code, 0) << replay.err;
      EXPECT_EQ(run({"trace", "study.yaml", "--point", point, "--trial", trial}).out, replay.out);
    }
  }
}

// Otherwise all of this could pass with the random numbers left out.
TEST_P(StudyDeterminism, EachSourceOfRandomnessChangesTheData) {
  write(6);
  complete("all.h5");
  const reading::AllTrialsFile all(folder_ / "all.h5");
  const auto theta = all.measure("final_position", all.rows());
  int number = 0;
  for (const char* without : {"encoder.fine_errors.noise=0", "encoder.fine_errors.missed=0", "dac.noise=0",
                              "initial.history={reversals: 0}", "seed=77"}) {
    const std::string name = std::to_string(number++) + ".h5";
    complete(name, {"--set", without});
    const reading::AllTrialsFile other(folder_ / name);
    if (other.measure("final_position", other.rows()) != theta) continue;
    // In an open loop the encoders only watch.
    EXPECT_NE(other.measure("final_error", other.rows()), all.measure("final_error", all.rows())) << without;
  }
}

}  // namespace
}  // namespace zerocount::testing
