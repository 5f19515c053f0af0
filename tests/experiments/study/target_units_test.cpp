// Targets in SI units are the same moves with every encoder, to the nearest of its counts.
#include "core/loop/encoder.hpp"
#include "core/theory/gains.hpp"
#include "experiments/study/sequence.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::study {
namespace {

void expect_nearest_counts(const StudyTrial& trial) {
  const trial::TrialParameters& p = trial.parameters;
  const double count = loop::fine_resolution(p.encoder);
  ASSERT_EQ(p.command.targets.size(), trial.target_positions.size());
  for (std::size_t i = 0; i < p.command.targets.size(); ++i) {
    const double position = trial.target_positions[i];
    EXPECT_LE(std::abs(static_cast<double>(p.command.targets[i]) * count - position),
              0.5 * count + 1e-12 * std::abs(position));
  }
}

TEST(TargetUnits, AreTheNearestCountsOfTheEncoderOfTheTrial) {
  const Study study =
      study_of(manifest_commanding("{units: si, targets: [{uniform: [-0.1, 0.1]}, 1.0e-4, {truncated_normal: "
                                   "{mean: 0, sd: 1.0e-5, low: -1, high: 1}}]}",
                                   "encoder: {fine: {integers: [100, 5000000]}}\n"),
               {"trials=400"});
  const std::size_t first = column_of(study, "command.targets.0");
  EXPECT_EQ(study.columns.inputs[first].unit, "rad");
  for (std::int64_t index = 0; index < study.trials; ++index) {
    const StudyTrial trial = study_trial(study, 0, index);
    EXPECT_EQ(trial.target_positions[0], trial.inputs[first]);
    EXPECT_EQ(trial.target_positions[1], 1.0e-4);
    expect_nearest_counts(trial);
  }
}

TEST(TargetUnits, AreTheSameMovesWhileTheEncoderIsSwept) {
  const Study study =
      study_of(manifest_commanding("{units: si, targets: [{uniform: [0.01, 0.02]}, 0]}",
                                   "sweep: {grid: {encoder.fine: [3600, 36000, 1620000]}}\n"));
  for (std::int64_t index = 0; index < study.trials; ++index) {
    const auto position = [&](std::int64_t point) {
      const StudyTrial trial = study_trial(study, point, index);
      expect_nearest_counts(trial);
      return trial.target_positions[0];
    };
    EXPECT_EQ(position(0), position(2));
    EXPECT_EQ(position(1), position(2));
  }
}

// A number of counts, written as the middle of the count in rad, gives the targets of the counts themselves.
TEST(TargetUnits, ATargetAtTheMiddleOfACountIsThatCount) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 200; ++i) {
    const int fine = std::uniform_int_distribution<int>(1, 10'000'000)(random);
    const int target = std::uniform_int_distribution<int>(-1'000'000, 1'000'000)(random);
    const std::string encoder = fmt::format("encoder: {{fine: {}}}\n", fine);
    const Study counts = study_of(manifest_commanding(fmt::format("{{targets: [{}]}}", target), encoder));
    const Study si = study_of(manifest_commanding(
        fmt::format("{{units: si, targets: [{:.17g}]}}", target * 2.0 * std::numbers::pi / fine), encoder));
    EXPECT_EQ(study_trial(si, 0, 0).parameters.command.targets,
              study_trial(counts, 0, 0).parameters.command.targets);
    EXPECT_TRUE(study_trial(counts, 0, 0).target_positions.empty());
  }
}

TEST(TargetUnits, SequencesIncludeTheirOverrun) {
  const Study study = study_of(manifest_commanding(
      "{units: si, sequence: {targets: [-0.01, {uniform: [0, 0.001]}, 0.02], overrun: 0.0015, cycles: 1}}",
      "encoder: {fine: {integers: [10000, 2000000]}}\n"));
  for (std::int64_t index = 0; index < study.trials; ++index) {
    const StudyTrial trial = study_trial(study, 0, index);
    expect_nearest_counts(trial);
    EXPECT_DOUBLE_EQ(trial.target_positions.front(), -0.0115);
    EXPECT_DOUBLE_EQ(trial.target_positions[4], 0.0215);
  }
}

TEST(TargetUnits, AreMetresOnALinearAxis) {
  const Study study = study_of(manifest_commanding(
      "{units: si, targets: [1.0e-6, {uniform: [-1.0e-3, 0]}]}",
      "axis: linear\nencoder: {resolution: {log_uniform: [1.0e-10, 1.0e-7]}}\n"
      "plant: {inertia: 5, sliding_damping: 0, presliding_damping: 0}\nfriction: {model: none}\n"
      "dac: {range: 100}\ncontroller: {ki: 0}\n"));
  EXPECT_EQ(study.columns.inputs[column_of(study, "command.targets.1")].unit, "m");
  for (std::int64_t index = 0; index < study.trials; ++index)
    expect_nearest_counts(study_trial(study, 0, index));
}

TEST(TargetUnits, FitTheHoldAndTheCounts) {
  EXPECT_EQ(
      refusal_of(manifest_commanding("{units: si, targets: [0.1], hold: 0.2, profile: {shape: trapezoidal, "
                                     "velocity_limit: 1, acceleration_limit: 100}}",
                                     "")),
      "");
  EXPECT_TRUE(has_faults(
      refusal_of(manifest_commanding("{units: si, targets: [0.1], hold: «0.1», profile: {shape: trapezoidal, "
                                     "velocity_limit: 1, acceleration_limit: 100}}",
                                     "")),
      "«»: command.hold | a travel of 0.1 rad"));
  EXPECT_TRUE(has_faults(refusal_of(manifest_commanding("{units: si, targets: [«1.0e+8»]}", "")),
                         "«»: encoder.fine | counts of this encoder"));
  EXPECT_TRUE(
      has_faults(refusal_of(manifest_commanding("{units: si, targets: [0.1, «{normal: {mean: 0, sd: 1}}»]}")),
                 "«»: command.targets.1 | unbounded"));
  EXPECT_TRUE(has_faults(
      refusal_of(manifest_commanding("{units: si, sequence: {targets: [0.1, «0.1»], overrun: 0.01}}", "")),
      "«»: command.sequence.targets.1 | 0.1 rad, not above"));
}

TEST(TargetUnits, UnknownWordsAndSweepsAreRefused) {
  EXPECT_TRUE(has_faults(refusal_of(manifest_commanding("{units: «rad», targets: [1]}")),
                         "«»: command.units | one of counts, si"));
  EXPECT_EQ(refusal_of(manifest_commanding("{units: counts, targets: [1]}")), "");
  EXPECT_TRUE(has_faults(refusal_of(manifest_commanding("{units: counts, targets: [«1.5»]}")),
                         "«»: command.targets.0 | not written as a whole number"));
  EXPECT_TRUE(has_faults(refusal_of(manifest_commanding("{units: «si», torque: {levels: [0.1]}}")),
                         "«»: command.units | the loop is open"));
  EXPECT_TRUE(says(refusal_of(minimal_manifest("sweep: {grid: {command.units: [counts, si]}}\n")),
                   "this key cannot be swept"));
}

// Gains in SI units are those of the continuous control: every trial has the same one, whatever its sample
// rate and its encoder.

void expect_gain(double gain, double expected) {
  EXPECT_NEAR(gain, expected, 4e-16 * expected);
}

// kp·Δx, ki·Δx·T/2 and kd·Δx/T of each trial.
TEST(GainUnits, AreConvertedWithTheSampleTimeAndTheCountOfTheTrial) {
  const Study study =
      study_of(minimal_manifest(
                   "encoder: {fine: {integers: [100000, 5000000]}, coarse: 86400}\n"
                   "controller: {units: si, sample_rate: {uniform: [500, 20000]}, kp: {uniform: [0, 200]},\n"
                   "  ki: {log_uniform: [1.0e+3, 1.0e+6]}, encoder: coarse,\n"
                   "  coarse: {coarse_beyond: 1000, kp: 100, ki: 2.0e+3, kd: 0.5, encoder: coarse}}\n"
                   "sweep: {grid: {dac.bits: [12, 16]}}\n"),
               {"trials=300"});
  const std::size_t kp = column_of(study, "controller.kp");
  const std::size_t ki = column_of(study, "controller.ki");
  EXPECT_EQ(study.columns.inputs[kp].unit, "N m/rad");
  EXPECT_EQ(study.columns.inputs[ki].unit, "N m/(rad s)");
  for (std::int64_t index = 0; index < study.trials; ++index) {
    const StudyTrial trial = study_trial(study, 1, index);
    const loop::ControllerParameters& c = trial.parameters.controller;
    // Both phases are fed back from the coarse encoder, whose counts are taken in fine ones.
    const double count = 2.0 * 3.14159265358979323846 / trial.parameters.encoder.fine;
    const double T = 1.0 / c.sample_rate;
    expect_gain(c.kp, trial.inputs[kp] * count);
    expect_gain(c.ki, trial.inputs[ki] * count * T / 2.0);
    EXPECT_EQ(c.kd, 0.0);
    expect_gain(c.coarse.kp, 100.0 * count);
    expect_gain(c.coarse.ki, 2.0e3 * count * T / 2.0);
    expect_gain(c.coarse.kd, 0.5 * count / T);
  }
}

TEST(GainUnits, AreTheSameContinuousControlAtEveryPointOfASweep) {
  const Study study = study_of(minimal_manifest(
      "controller: {units: si, kp: 10, ki: 4.0e+4, kd: 0.02}\n"
      "sweep: {grid: {controller.sample_rate: [500, 2000, 10000], encoder.fine: [36000, 1620000]}}\n"));
  ASSERT_EQ(point_count(study), 6);
  for (std::int64_t point = 0; point < 6; ++point) {
    const trial::TrialParameters p = study_trial(study, point, 0).parameters;
    const theory::AnalogueGains gains = theory::analogue_gains(p.controller, p.encoder);
    EXPECT_NEAR(gains.kp, 10.0, 1e-14);
    EXPECT_NEAR(gains.ki, 4.0e4, 1e-10);
    EXPECT_NEAR(gains.kd, 0.02, 1e-16);
  }
}

TEST(GainUnits, GainsPerCountAreTakenUnchanged) {
  const StudyTrial trial = study_trial(
      study_of(minimal_manifest("controller: {units: count, kp: 1.0e-4, ki: 2.0e-5, kd: 3.0e-4}\n")), 0, 0);
  EXPECT_EQ(trial.parameters.controller.kp, 1.0e-4);
  EXPECT_EQ(trial.parameters.controller.ki, 2.0e-5);
  EXPECT_EQ(trial.parameters.controller.kd, 3.0e-4);
}

// 3.85e-5 N m/count is not 3.85e-5 N m/(rad s).
TEST(GainUnits, DefaultsPerCountAreNotUsedInSiUnits) {
  const char* const missing = "1:1: controller.ki | missing";
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {units: si}\n")), missing));
  EXPECT_TRUE(has_faults(
      refusal_of(minimal_manifest("controller: {units: si}\n"
                                  "sweep: {cases: {a: {controller.ki: 1}, b: {controller.kp: 1}}}\n")),
      missing));
  EXPECT_EQ(refusal_of(minimal_manifest("controller: {units: si}\nsweep: {grid: {controller.ki: [1, 2]}}\n")),
            "");
  EXPECT_EQ(refusal_of(minimal_manifest("controller: {units: si, ki: 0}\n")), "");
  EXPECT_EQ(refusal_of(manifest_commanding("{torque: {levels: [0.1]}}", "controller: {units: si}\n")), "");
}

TEST(GainUnits, UnknownWordsAndSweepsAreRefused) {
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("controller: {units: «SI»}\n")), "«»: controller.units | 'SI'"));
  EXPECT_TRUE(says(refusal_of(minimal_manifest("sweep: {grid: {controller.units: [count, si]}}\n")),
                   "this key cannot be swept"));
}

// The range of the converter gives its resolution, in every trial and with every word length.

TEST(ConverterRange, GivesTheResolutionOfEveryTrial) {
  const Study study =
      study_of(minimal_manifest("dac: {bits: {integers: [1, 32]}, range: {log_uniform: [1.0e-3, 1.0e+3]}}\n"),
               {"trials=500"});
  const std::size_t range = column_of(study, "dac.range");
  for (std::int64_t index = 0; index < study.trials; ++index) {
    const StudyTrial trial = study_trial(study, 0, index);
    const loop::DacParameters& dac = trial.parameters.dac;
    EXPECT_DOUBLE_EQ(dac.resolution, trial.inputs[range] / std::pow(2.0, dac.bits - 1)) << index;
    EXPECT_EQ(commanded_trial(study, 0, index).parameters.dac.resolution, dac.resolution) << index;
  }
  EXPECT_EQ(study.columns.inputs[range].unit, "N m");
}

// Random numbers in both forms.
TEST(ConverterRange, IsEquivalentToAResolution) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 200; ++i) {
    const int bits = std::uniform_int_distribution<int>(1, 32)(random);
    const double range = std::exp(std::uniform_real_distribution(-9.0, 9.0)(random));
    const double resolution = std::ldexp(range, 1 - bits);
    const auto of = [&](const std::string& key, double value) {
      const Study study =
          study_of(minimal_manifest(fmt::format("dac: {{bits: {}, {}: {:.17g}}}\n", bits, key, value)));
      return study_trial(study, 0, 0).parameters.dac.resolution;
    };
    EXPECT_EQ(of("range", range), of("resolution", resolution));
  }
}

TEST(ConverterRange, IsKeptWhileTheWordLengthIsSwept) {
  const Study study =
      study_of(minimal_manifest("dac: {range: 0.5}\nsweep: {grid: {dac.bits: [1, 8, 12, 16]}}\n"));
  for (std::int64_t point = 0; point < 4; ++point) {
    const loop::DacParameters dac = study_trial(study, point, 0).parameters.dac;
    EXPECT_EQ(dac.resolution * std::pow(2.0, dac.bits - 1), 0.5);
  }
}

TEST(ConverterRange, ExcludesAResolution) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("dac: {resolution: «2.4e-4», range: 0.5}\n")),
                         "«»: dac.resolution | dac.range | either"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("dac: {range: «0»}\n")),
                         "«»: dac.range | greater than 0 | or none"));
  EXPECT_EQ(refusal_of(minimal_manifest("dac: {resolution: 2.4e-4, range: none}\n")), "");
  // Each has an effect at one of the points.
  EXPECT_EQ(refusal_of(minimal_manifest(
                "sweep: {cases: {a: {dac.resolution: 1.0e-4}, b: {dac.range: {uniform: [0.4, 0.5]}}}}\n")),
            "");
  EXPECT_TRUE(
      has_faults(study_of(manifest_commanding("{torque: {levels: [«0.4»]}}", "dac: {range: 0.3}\n")).warnings,
                 "«»: command.torque.levels.0 | clipped"));
}

// Without it the resolution of a linear axis is required, because its default is in N m.
TEST(ConverterRange, SufficesOnALinearAxis) {
  const auto linear = [](const std::string& dac) {
    return manifest_commanding("{torque: {levels: [0], rate: 1}}",
                               "axis: linear\nencoder: {resolution: 1.0e-9}\n"
                               "plant: {inertia: 5, sliding_damping: 0, presliding_damping: 0}\n"
                               "friction: {model: none}\n" +
                                   dac);
  };
  EXPECT_EQ(refusal_of(linear("dac: {range: 100}\n")), "");
  EXPECT_TRUE(says(refusal_of(linear("dac: {bits: 16}\n")), "dac.resolution"));
}

// What a sequence of moves promises, for random sequences.

struct RandomSequence {
  SequenceCycle cycle;
  std::vector<double> targets;  // ascending
  double overrun;
};

RandomSequence random_sequence(std::mt19937_64& draws) {
  const auto whole = [&](std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(draws);
  };
  RandomSequence sequence;
  sequence.cycle.cycles = whole(1, 7);
  sequence.cycle.approach = static_cast<SequenceApproach>(whole(0, 2));
  double last = static_cast<double>(whole(-5000, 5000));
  for (std::int64_t i = whole(1, 12); i > 0; --i) {
    sequence.targets.push_back(last);
    last += static_cast<double>(whole(1, 2000));
  }
  sequence.overrun = static_cast<double>(whole(1, 500));
  return sequence;
}

class SequenceProperties : public ::testing::Test {
 protected:
  template <class Check>
  void for_random_sequences(Check check) {
    std::mt19937_64 draws(20020721);
    for (int i = 0; i < 2000; ++i) {
      const RandomSequence s = random_sequence(draws);
      check(s, sequence_moves(s.cycle, std::ssize(s.targets)));
      if (HasFatalFailure()) return;
    }
  }

  static double position(const RandomSequence& s, const SequenceMove& move) {
    return sequence_position(move, s.targets, s.overrun);
  }
};

TEST_F(SequenceProperties, EachTargetIsReachedOnceInEachCycleFromEachSide) {
  for_random_sequences([](const RandomSequence& s, const std::vector<SequenceMove>& moves) {
    std::map<std::tuple<std::int64_t, int, std::int64_t>, int> times;  // target, direction, cycle
    for (const SequenceMove& move : moves) {
      if (move.target >= 0) ++times[{move.target, move.direction, move.cycle}];
    }
    const std::size_t sides = s.cycle.approach == SequenceApproach::bidirectional ? 2 : 1;
    ASSERT_EQ(times.size(), s.targets.size() * sides * static_cast<std::size_t>(s.cycle.cycles));
    for (const auto& [what, count] : times) {
      ASSERT_EQ(count, 1);
      ASSERT_NE(std::get<1>(what), s.cycle.approach == SequenceApproach::negative   ? 1
                                   : s.cycle.approach == SequenceApproach::positive ? -1
                                                                                    : 0);
    }
  });
}

TEST_F(SequenceProperties, ATargetIsApproachedFromTheSideOfItsMove) {
  for_random_sequences([](const RandomSequence& s, const std::vector<SequenceMove>& moves) {
    ASSERT_LT(moves.front().target, 0) << "the first target is approached from somewhere, too";
    for (std::size_t i = 1; i < moves.size(); ++i) {
      if (moves[i].target < 0) continue;
      const double travel = position(s, moves[i]) - position(s, moves[i - 1]);
      ASSERT_GT(travel * moves[i].direction, 0);
    }
  });
}

TEST_F(SequenceProperties, TheOverrunIsBeyondAllTargets) {
  for_random_sequences([](const RandomSequence& s, const std::vector<SequenceMove>& moves) {
    for (const SequenceMove& move : moves) {
      if (move.target >= 0) continue;
      ASSERT_EQ(position(s, move),
                move.direction < 0 ? s.targets.front() - s.overrun : s.targets.back() + s.overrun);
    }
  });
}

TEST_F(SequenceProperties, CyclesFollowOnEachOtherAndAreAlike) {
  for_random_sequences([](const RandomSequence& s, const std::vector<SequenceMove>& moves) {
    ASSERT_EQ(std::ssize(moves), sequence_move_count(s.cycle, std::ssize(s.targets)));
    const std::size_t length = moves.size() / static_cast<std::size_t>(s.cycle.cycles);
    for (std::size_t i = 0; i < moves.size(); ++i) {
      ASSERT_EQ(moves[i].cycle, static_cast<std::int64_t>(i / length));
      ASSERT_EQ(moves[i].target, moves[i % length].target);
      ASSERT_EQ(moves[i].direction, moves[i % length].direction);
    }
  });
}

}  // namespace
}  // namespace zerocount::study
