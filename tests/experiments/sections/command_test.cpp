// Three ways to say what the moves go to.
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::sections {
namespace {

using Names = std::vector<std::string>;

std::string refused(const std::string& command, const std::string& more = "") {
  return refusal_of(manifest_commanding(command, more));
}

TEST(Command, TakesExactlyOneForm) {
  EXPECT_TRUE(has_faults(refused("«{hold: 1}»"), "«»: command | exactly one of"));
  EXPECT_TRUE(
      has_faults(refused("{targets: [1], «torque»: {levels: [0.1]}}"), "«»: command.torque | already"));
  EXPECT_TRUE(has_faults(refused("{sequence: {targets: [1, 2], overrun: 1}, hold: 1, «targets»: [1]}"),
                         "«»: command.targets | already"));
  EXPECT_TRUE(has_faults(refused("{torque: {levels: [0.1]}, «targets»: [1], sequence: {cycles: 0}}"),
                         "«»: command.targets | already"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(), {"command.torque.levels=[0.1]"}),
                         "--set command.torque.levels=[0.1]: command.torque | already"));
  EXPECT_TRUE(has_faults(refused("{targets: [1], «torque»: {levels: [no], rate: 0}, hold: 1}"),
                         "«»: command.torque | already"));
  EXPECT_TRUE(has_faults(refused("«[1]»"), "«»: command | a list"));
}

TEST(Command, FormsAreComplete) {
  EXPECT_TRUE(has_faults(refused("{torque: «{rate: 0.2}»}"), "«»: command.torque.levels | missing"));
  EXPECT_TRUE(has_faults(refused("{sequence: «{cycles: 2}»}"),
                         "«»: command.sequence.targets | missing\n"
                         "«»: command.sequence.overrun | missing"));
  EXPECT_TRUE(has_faults(refused("{torque: «[0.1]»}"), "«»: command.torque | a list"));
  EXPECT_TRUE(has_faults(refused("{torque: {levels: «[]»}}"), "«»: command.torque.levels | list of 0"));
}

TEST(Command, TorqueLevelsAreMovesWithoutTargets) {
  const study::Study study = study_of(
      manifest_commanding("{torque: {levels: [0.1, {uniform: [-0.2, -0.1]}, 0], rate: 0.5, through: exact}, "
                          "hold: 0.2}"));
  EXPECT_TRUE(study.open_loop);
  EXPECT_EQ(study.moves, 3);
  EXPECT_TRUE(study.sequence.empty());
  ASSERT_EQ(study.columns.inputs.size(), 1u);
  EXPECT_EQ(study.columns.inputs[0].name, "command.torque.levels.1");
  EXPECT_EQ(study.columns.inputs[0].unit, "N m");
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
  EXPECT_EQ(study.points.labels[5], "command.torque.levels.0=0.2, command.torque.rate=2");
  EXPECT_EQ(study::study_trial(study, 5, 0).parameters.command.torque.levels, (std::vector<double>{0.2, 0}));
  const study::Study whole = study_of(manifest_commanding(
      "{torque: {levels: [0.1, 0]}}", "sweep: {grid: {command.torque.levels: [[0.1, 0], [0.2, 0.1]]}}\n"));
  EXPECT_EQ(study::study_trial(whole, 1, 0).parameters.command.torque.levels,
            (std::vector<double>{0.2, 0.1}));
}

TEST(Command, OnlyTheFormInUseCanBeSwept) {
  EXPECT_TRUE(has_faults(refused("{torque: {levels: [0.1]}}", "sweep: {grid: {«command.targets.0»: [1]}}"),
                         "«»: sweep.grid.command.targets.0 | the study has no"));
  EXPECT_TRUE(
      has_faults(refused("{torque: {levels: [0.1]}}", "sweep: {grid: {«command.torque.levels.1»: [1]}}"),
                 "«»: sweep.grid.command.torque.levels.1 | an index from 0 to 0"));
  EXPECT_TRUE(
      has_faults(refused("{targets: [1]}", "sweep: {cases: {a: {«command.sequence.targets»: [1, 2]}}}"),
                 "«»: sweep.cases.a.command.sequence.targets | the study has no"));
  EXPECT_TRUE(
      has_faults(refused("{torque: {levels: [0.1]}}", "sweep: {grid: {command.torque.levels: [«[1, 2]»]}}"),
                 "«»: sweep.grid.command.torque.levels.0 | list of 2 levels"));
}

TEST(Command, ASequenceIsExpandedIntoMoves) {
  const study::Study study = study_of(
      manifest_commanding("{sequence: {targets: [-50, {integers: [1, 9]}, 60], overrun: 20, cycles: 2}}"));
  EXPECT_FALSE(study.open_loop);
  EXPECT_EQ(study.moves, 16);
  ASSERT_EQ(study.sequence.size(), 16u);
  ASSERT_EQ(study.columns.inputs.size(), 1u);
  EXPECT_EQ(study.columns.inputs[0].name, "command.sequence.targets.1");
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
  EXPECT_EQ(study.columns.inputs[0].name, "command.sequence.targets.1");
  EXPECT_EQ(study.columns.inputs[1].name, "command.sequence.overrun");
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
  EXPECT_TRUE(has_faults(refused(sequence, "sweep: {grid: {«command.sequence.cycles»: [1, 2]}}"),
                         "«»: sweep.grid.command.sequence.cycles | cannot be swept"));
  EXPECT_TRUE(has_faults(refused("{sequence: {targets: [1, 5], overrun: 2, cycles: «{integers: [1, 2]}»}}"),
                         "«»: command.sequence.cycles | a map"));
  EXPECT_TRUE(has_faults(refused("{sequence: {targets: [1, 5], overrun: 2, approach: «both»}}"),
                         "«»: command.sequence.approach | 'both'"));
  EXPECT_TRUE(has_faults(refused("{sequence: {targets: [1, 5], overrun: «0»}}"),
                         "«»: command.sequence.overrun | from 1 to 1000000000000"));
  EXPECT_TRUE(has_faults(refused("{sequence: «{targets: [1, 5], overrun: 2, cycles: 20000}»}"),
                         "«»: command.sequence | 100000 moves"));
  EXPECT_EQ(study_of(manifest_commanding(sequence), {"command.sequence.cycles=1"}).moves, 6);
}

TEST(Command, TheTargetsOfASequenceAscendInEveryTrial) {
  EXPECT_TRUE(has_faults(refused("{sequence: {targets: [1, 5, «5»], overrun: 2}}"),
                         "«»: command.sequence.targets.2 | ascending"));
  EXPECT_TRUE(
      has_faults(refused("{sequence: {targets: [{integers: [1, 9]}, «{integers: [9, 20]}»], overrun: 2}}"),
                 "«»: command.sequence.targets.1 | ascending"));
  EXPECT_TRUE(has_faults(refused("{sequence: {targets: [1, 10], overrun: 2}}",
                                 "sweep: {grid: {command.sequence.targets.0: [5, «12»]}}"),
                         "«»: command.sequence.targets.1 | ascending"));
  EXPECT_TRUE(has_faults(refused("{sequence: {targets: [1, 10], overrun: «1000000000000»}}"),
                         "«»: command.sequence.overrun | 1000000000010"));
}

TEST(Command, ListsShareTheSobolDimensionsButNotTheDraws) {
  // Value i of any list has the same point of the sequence, shifted by its own name.
  const study::Study targets =
      study_of(manifest_commanding("{targets: [{integers: [0, 999999]}]}", "design: sobol\n"));
  const study::Study levels =
      study_of(manifest_commanding("{torque: {levels: [{uniform: [0, 1]}]}}", "design: sobol\n"));
  EXPECT_NE(std::floor(1e6 * study::study_trial(levels, 0, 3).inputs[0]),
            study::study_trial(targets, 0, 3).inputs[0]);
  EXPECT_EQ(study_of(manifest_commanding("{targets: [1]}")).columns.inputs.size(), 0u);
}

}  // namespace
}  // namespace zerocount::sections
