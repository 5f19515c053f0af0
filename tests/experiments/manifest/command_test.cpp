// Three ways to say what the moves go to.

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::manifest {
namespace {

using Names = std::vector<std::string>;

std::string refused(const std::string& command, const std::string& more = "") {
  return refusal_of(manifest_commanding(command, more));
}

TEST(Command, TakesExactlyOneForm) {
  const std::string expected = "; expected exactly one of targets, torque, sequence";
  EXPECT_EQ(refused("{hold: 1}"), "m.yaml:5:10: command: it does not say what the moves go to" + expected);
  EXPECT_EQ(refused("{targets: [1], torque: {levels: [0.1]}}"),
            "m.yaml:5:25: command.torque: command.targets says already what the moves go to" + expected);
  EXPECT_EQ(refused("{sequence: {targets: [1, 2], overrun: 1}, hold: 1, targets: [1]}"),
            "m.yaml:5:61: command.targets: command.sequence says already what the moves go to" + expected);
  EXPECT_EQ(refused("{torque: {levels: [0.1]}, targets: [1], sequence: {cycles: 0}}"),
            "m.yaml:5:36: command.targets: command.torque says already what the moves go to" + expected);
  EXPECT_EQ(refusal_of(minimal_manifest(), {"command.torque.levels=[0.1]"}),
            "--set command.torque.levels=[0.1]: command.torque: command.targets says already what the moves "
            "go to" +
                expected);
  EXPECT_EQ(refused("{targets: [1], torque: {levels: [no], rate: 0}, hold: 1}"),
            "m.yaml:5:25: command.torque: command.targets says already what the moves go to" + expected);
  EXPECT_EQ(refused("[1]"), "m.yaml:5:10: command: a list stands here; expected a map");
}

TEST(Command, FormsAreComplete) {
  EXPECT_EQ(refused("{torque: {rate: 0.2}}"),
            "m.yaml:5:19: command.torque.levels: the key is missing; expected a list of levels");
  EXPECT_EQ(refused("{sequence: {cycles: 2}}"),
            "m.yaml:5:21: command.sequence.targets: the key is missing; expected a list of targets\n"
            "m.yaml:5:21: command.sequence.overrun: the key is missing; expected its value: how far beyond "
            "the first and the last target a sequence turns round");
  EXPECT_EQ(refused("{torque: [0.1]}"), "m.yaml:5:19: command.torque: a list stands here; expected a map");
  EXPECT_EQ(refused("{torque: {levels: []}}"),
            "m.yaml:5:28: command.torque.levels: a list of 0 stands here; expected a list of 1 to 3000 "
            "levels");
}

TEST(Command, TorqueLevelsAreMovesWithoutTargets) {
  const study::Study study = study_of(
      manifest_commanding("{torque: {levels: [0.1, {uniform: [-0.2, -0.1]}, 0], rate: 0.5, through: exact}, "
                          "hold: 0.2}"));
  EXPECT_TRUE(study.open_loop);
  EXPECT_EQ(study.moves, 3);
  EXPECT_TRUE(study.sequence.empty());
  ASSERT_EQ(study.input_columns.size(), 1u);
  EXPECT_EQ(study.input_columns[0].name, "command.torque.levels.1");
  EXPECT_EQ(study.input_columns[0].unit, "N m");
  for (std::int64_t i = 0; i < 10; ++i) {
    const study::StudyTrial trial = study::study_trial(study, 0, i);
    const trial::CommandParameters& command = trial.parameters.command;
    EXPECT_TRUE(command.targets.empty());
    ASSERT_EQ(command.torque.levels.size(), 3u);
    EXPECT_EQ(command.torque.levels[0], 0.1);
    EXPECT_GE(command.torque.levels[1], -0.2);
    EXPECT_LT(command.torque.levels[1], -0.1);
    EXPECT_EQ(command.torque.levels[2], 0);
    EXPECT_EQ(trial.inputs[0], command.torque.levels[1]);
    EXPECT_EQ(command.torque.rate, 0.5);
    EXPECT_EQ(command.torque.through, trial::TorquePath::exact);
    EXPECT_EQ(trial::move_count(trial.parameters), 3u);
  }
}

TEST(Command, TorqueLevelsAreSwept) {
  const study::Study study = study_of(manifest_commanding(
      "{torque: {levels: [0.1, 0]}}",
      "sweep: {grid: {command.torque.levels.0: {linspace: [0.1, 0.2, 3]}, command.torque.rate: [1, 2]}}\n"));
  EXPECT_EQ(study.point_labels[5], "command.torque.levels.0=0.2, command.torque.rate=2");
  EXPECT_EQ(study::study_trial(study, 5, 0).parameters.command.torque.levels, (std::vector<double>{0.2, 0}));
  const study::Study whole = study_of(manifest_commanding(
      "{torque: {levels: [0.1, 0]}}", "sweep: {grid: {command.torque.levels: [[0.1, 0], [0.2, 0.1]]}}\n"));
  EXPECT_EQ(study::study_trial(whole, 1, 0).parameters.command.torque.levels,
            (std::vector<double>{0.2, 0.1}));
}

TEST(Command, OnlyTheFormInUseIsSwept) {
  EXPECT_EQ(refused("{torque: {levels: [0.1]}}", "sweep: {grid: {command.targets.0: [1]}}"),
            "m.yaml:6:16: sweep.grid.command.targets.0: the study has no command.targets; expected "
            "command.torque.levels, which it has");
  EXPECT_EQ(refused("{torque: {levels: [0.1]}}", "sweep: {grid: {command.torque.levels.1: [1]}}"),
            "m.yaml:6:16: sweep.grid.command.torque.levels.1: there is no such level; expected an index from "
            "0 to 0");
  EXPECT_EQ(refused("{targets: [1]}", "sweep: {cases: {a: {command.sequence.targets: [1, 2]}}}"),
            "m.yaml:6:21: sweep.cases.a.command.sequence.targets: the study has no command.sequence.targets; "
            "expected command.targets, which it has");
  EXPECT_EQ(refused("{torque: {levels: [0.1]}}", "sweep: {grid: {command.torque.levels: [[1, 2]]}}"),
            "m.yaml:6:40: sweep.grid.command.torque.levels.0: a list of 2 levels stands here; expected a "
            "list of 1 levels, as at every point");
}

TEST(Command, ASequenceIsExpandedIntoMoves) {
  const study::Study study = study_of(
      manifest_commanding("{sequence: {targets: [-50, {integers: [1, 9]}, 60], overrun: 20, cycles: 2}}"));
  EXPECT_FALSE(study.open_loop);
  EXPECT_EQ(study.moves, 16);
  ASSERT_EQ(study.sequence.size(), 16u);
  ASSERT_EQ(study.input_columns.size(), 1u);
  EXPECT_EQ(study.input_columns[0].name, "command.sequence.targets.1");
  for (std::int64_t i = 0; i < 10; ++i) {
    const study::StudyTrial trial = study::study_trial(study, 0, i);
    const auto middle = static_cast<std::int64_t>(trial.inputs[0]);
    const std::vector<std::int64_t> cycle{-70, -50, middle, 60, 80, 60, middle, -50};
    std::vector<std::int64_t> both = cycle;
    both.insert(both.end(), cycle.begin(), cycle.end());
    EXPECT_EQ(trial.parameters.command.targets, both);
  }
}

TEST(Command, ASequenceFromOneSide) {
  const std::string targets = "{sequence: {targets: [1, 5], overrun: 2, cycles: 2, approach: ";
  EXPECT_EQ(study::study_trial(study_of(manifest_commanding(targets + "positive}}")), 0, 0)
                .parameters.command.targets,
            (std::vector<std::int64_t>{-1, 1, 5, -1, 1, 5}));
  EXPECT_EQ(study::study_trial(study_of(manifest_commanding(targets + "negative}}")), 0, 0)
                .parameters.command.targets,
            (std::vector<std::int64_t>{7, 5, 1, 7, 5, 1}));
}

TEST(Command, FiveCyclesFromBothSidesAreTheDefault) {
  const study::Study study = study_of(manifest_commanding("{sequence: {targets: [1], overrun: 1}}"));
  EXPECT_EQ(study.moves, 20);
  EXPECT_EQ(study.sequence.back().cycle, 4);
  EXPECT_EQ(study.sequence.back().direction, -1);
}

TEST(Command, TheOverrunIsAParameterLikeAnyOther) {
  const study::Study study =
      study_of(manifest_commanding("{sequence: {targets: [0, 10], overrun: {integers: [5, 9]}, cycles: 1}}",
                                   "sweep: {grid: {command.sequence.targets.1: [10, 20]}}\n"));
  EXPECT_EQ(study.input_columns[0].name, "command.sequence.targets.1");
  EXPECT_EQ(study.input_columns[1].name, "command.sequence.overrun");
  std::set<std::int64_t> first;
  for (std::int64_t i = 0; i < 10; ++i) {
    const study::StudyTrial trial = study::study_trial(study, 1, i);
    const auto overrun = static_cast<std::int64_t>(trial.inputs[1]);
    EXPECT_EQ(trial.parameters.command.targets.front(), -overrun);
    EXPECT_EQ(trial.parameters.command.targets[3], 20 + overrun);
    first.insert(overrun);
  }
  EXPECT_GT(first.size(), 1u);
}

TEST(Command, TheShapeOfASequenceIsTheSameEverywhere) {
  const std::string sequence = "{sequence: {targets: [1, 5], overrun: 2}}";
  EXPECT_EQ(refused(sequence, "sweep: {grid: {command.sequence.cycles: [1, 2]}}"),
            "m.yaml:6:16: sweep.grid.command.sequence.cycles: this key is the same at all points; expected a "
            "dotted path of the table of parameters, such as controller.ki");
  EXPECT_EQ(refused("{sequence: {targets: [1, 5], overrun: 2, cycles: {integers: [1, 2]}}}"),
            "m.yaml:5:59: command.sequence.cycles: a map stands here; expected a whole number from 1 to "
            "100000");
  EXPECT_EQ(refused("{sequence: {targets: [1, 5], overrun: 2, approach: both}}"),
            "m.yaml:5:61: command.sequence.approach: 'both' is none of its words; expected one of "
            "bidirectional, positive, negative");
  EXPECT_EQ(refused("{sequence: {targets: [1, 5], overrun: 0}}"),
            "m.yaml:5:48: command.sequence.overrun: '0' is out of range; expected a whole number from 1 to "
            "1000000000000");
  EXPECT_EQ(refused("{sequence: {targets: [1, 5], overrun: 2, cycles: 20000}}"),
            "m.yaml:5:21: command.sequence: it has 120000 moves; expected at most 100000 moves, cycles times "
            "those of a cycle");
  EXPECT_EQ(study_of(manifest_commanding(sequence), {"command.sequence.cycles=1"}).moves, 6);
}

TEST(Command, TheTargetsOfASequenceAscendInEveryTrial) {
  EXPECT_EQ(refused("{sequence: {targets: [1, 5, 5], overrun: 2}}"),
            "m.yaml:5:38: command.sequence.targets.2: the target can be at 5 counts, at or below the one "
            "before it, 5 "
            "counts; expected targets in ascending order in every trial");
  EXPECT_EQ(refused("{sequence: {targets: [{integers: [1, 9]}, {integers: [9, 20]}], overrun: 2}}"),
            "m.yaml:5:52: command.sequence.targets.1: the target can be at 9 counts, at or below the one "
            "before it, 9 "
            "counts; expected targets in ascending order in every trial");
  EXPECT_EQ(refused("{sequence: {targets: [1, 10], overrun: 2}}",
                    "sweep: {grid: {command.sequence.targets.0: [5, 12]}}"),
            "m.yaml:6:48: command.sequence.targets.1: the target can be at 10 counts, at or below the one "
            "before it, 12 "
            "counts; expected targets in ascending order in every trial");
  EXPECT_EQ(refused("{sequence: {targets: [1, 10], overrun: 1000000000000}}"),
            "m.yaml:5:49: command.sequence.overrun: the sequence can go as far as 1000000000010 counts; "
            "expected at most 1000000000000 counts from the start");
}

TEST(Command, ListsShareTheSobolDimensionsAndNothingElse) {
  // Value i of any list has the same point of the sequence, shifted by its own name.
  const study::Study targets =
      study_of(manifest_commanding("{targets: [{integers: [0, 999999]}]}", "design: sobol\n"));
  const study::Study levels =
      study_of(manifest_commanding("{torque: {levels: [{uniform: [0, 1]}]}}", "design: sobol\n"));
  EXPECT_NE(std::floor(1e6 * study::study_trial(levels, 0, 3).inputs[0]),
            study::study_trial(targets, 0, 3).inputs[0]);
  EXPECT_EQ(study_of(manifest_commanding("{targets: [1]}")).input_columns.size(), 0u);
}

}  // namespace
}  // namespace zerocount::manifest
