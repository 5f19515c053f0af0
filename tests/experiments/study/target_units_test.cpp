// Targets in SI units are the same moves with every encoder, to the nearest of its counts.
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/loop/encoder.hpp"
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
TEST(TargetUnits, OfCountsAreThoseCounts) {
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

TEST(TargetUnits, OfASequenceIncludeItsOverrun) {
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
      refusal_of(manifest_commanding("{units: si, targets: [0.1], hold: 0.1, profile: {shape: trapezoidal, "
                                     "velocity_limit: 1, acceleration_limit: 100}}",
                                     "")),
      "5:44: command.hold | a travel of 0.1 rad"));
  EXPECT_TRUE(has_faults(refusal_of(manifest_commanding("{units: si, targets: [1.0e+8]}", "")),
                         "5:32: encoder.fine | counts of this encoder"));
  EXPECT_TRUE(
      has_faults(refusal_of(manifest_commanding("{units: si, targets: [0.1, {normal: {mean: 0, sd: 1}}]}")),
                 "5:37: command.targets.1 | unbounded"));
  EXPECT_TRUE(has_faults(
      refusal_of(manifest_commanding("{units: si, sequence: {targets: [0.1, 0.1], overrun: 0.01}}", "")),
      "5:48: command.sequence.targets.1 | 0.1 rad, not above"));
}

TEST(TargetUnits, HaveAWordAndAreTheSameAtAllPoints) {
  EXPECT_TRUE(has_faults(refusal_of(manifest_commanding("{units: rad, targets: [1]}")),
                         "5:18: command.units | one of counts, si"));
  EXPECT_EQ(refusal_of(manifest_commanding("{units: counts, targets: [1]}")), "");
  EXPECT_TRUE(has_faults(refusal_of(manifest_commanding("{units: counts, targets: [1.5]}")),
                         "5:36: command.targets.0 | not written as a whole number"));
  EXPECT_TRUE(has_faults(refusal_of(manifest_commanding("{units: si, torque: {levels: [0.1]}}")),
                         "5:18: command.units | the loop is open"));
  EXPECT_NE(refusal_of(minimal_manifest("sweep: {grid: {command.units: [counts, si]}}\n"))
                .find("this key cannot be swept"),
            std::string::npos);
}

}  // namespace
}  // namespace zerocount::study
