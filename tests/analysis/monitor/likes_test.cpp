// Moves beside those that are like them.
#include "analysis/monitor/likes.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "tests/analysis/monitor/move_sequences.hpp"

namespace zerocount::testing {
namespace {

using monitor::MachineMonitor;
using monitor::MachineStatus;
using monitor::MonitorSettings;

/// A monitor after all moves of a log.
MachineMonitor watched(const std::string& before, const std::string& after,
                       const MonitorSettings& settings = {}) {
  const monitor::MoveLog log = log_of(after);
  MachineMonitor machine(monitor::baseline_of(log_of(before, "baseline.csv")), log, settings);
  machine.update(log);
  return machine;
}

/// Moves between targets in turns: settling times of each about its own median, and torques that hold the
/// rotor against friction, in the direction of the move.
struct Program {
  std::vector<double> targets{10.0, -10.0};
  std::vector<double> medians{0.02, 0.06};
  double time_factor{1.0};
  double torque_factor{1.0};
  bool shuffled{false};
};

std::string log_of_program(const Program& program, int moves, random::NumberSource& numbers,
                           const std::string& head = "move,target,settling_time,holding_torque") {
  std::string text = head + "\n";
  double before = 0.0;
  for (int i = 0; i < moves; ++i) {
    auto number = static_cast<std::size_t>(i) % program.targets.size();
    if (program.shuffled)
      number = static_cast<std::size_t>(numbers.uniform() * static_cast<double>(program.targets.size()));
    const double target = program.targets[number];
    const double time = program.time_factor * program.medians[number] * std::exp(0.1 * numbers.normal());
    const double torque =
        (target > before ? 1.0 : -1.0) * program.torque_factor * 0.3 * (1.0 + 0.03 * numbers.normal());
    before = target;
    if (head.starts_with("move,target"))
      text += fmt::format("{},{},", number, target);
    else if (head.starts_with("move"))
      text += fmt::format("{},", number);
    else if (head.starts_with("target"))
      text += fmt::format("{},", target);
    text += fmt::format("{},{}\n", time, torque);
  }
  return text;
}

// Friction that rises holds the rotor with more torque in both directions.
TEST(Likes, TakeSignedMeasuresInTheDirectionOfTheMove) {
  for (const char* const head : {"move,target,settling_time,holding_torque",
                                 "move,settling_time,holding_torque", "target,settling_time,holding_torque"})
    for (const bool mirrored : {false, true}) {
      random::NumberSource numbers = numbers_of("directions", 1);
      Program program;
      if (mirrored) program.targets = {-10.0, 10.0};
      const std::string before = log_of_program(program, 300, numbers, head);
      std::string after = log_of_program(program, 300, numbers, head);
      program.torque_factor = 1.05;
      const std::string changed = log_of_program(program, 300, numbers, head);
      after += changed.substr(changed.find('\n') + 1);
      MachineMonitor machine = watched(before, after);
      const monitor::MonitorState state = machine.state();
      ASSERT_NE(state.alarm, nullptr) << head;
      EXPECT_EQ(state.alarm->measure.name, "holding_torque");
      EXPECT_EQ(*state.alarm->direction, monitor::Direction::higher) << head;
      EXPECT_GT(*state.alarm->alarm_at, 300);
      EXPECT_NEAR(static_cast<double>(*state.alarm->since), 301.0, 15.0);
      EXPECT_NEAR(*state.alarm->median, 0.315, 0.003);
      EXPECT_NEAR(*state.alarm->baseline_median, 0.3, 0.003);
    }
}

// As many moves of each kind as before, or not: a program that runs one of its moves more often is no change
// of the machine. Ranked among all moves it would be: here in each of 40 sequences.
TEST(Likes, AreNotAChangeWhereTheMixtureChanges) {
  constexpr std::uint32_t sequences = 40;
  int false_alarms = 0;
  int without_labels = 0;
  for (std::uint32_t i = 0; i < sequences; ++i) {
    random::NumberSource numbers = numbers_of("mixture", i);
    const std::string before = log_of_program({}, 200, numbers);
    const std::string after = log_of_program(
        {.targets = {10.0, -10.0, -10.0, -10.0}, .medians = {0.02, 0.06, 0.06, 0.06}, .shuffled = true}, 300,
        numbers);
    const auto relabelled = [](std::string text) {
      // The third and fourth move of the shuffled program are its second again.
      for (const char* const number : {"\n2,", "\n3,"})
        for (std::size_t at = text.find(number); at != std::string::npos; at = text.find(number, at + 1))
          text[at + 1] = '1';
      return text;
    };
    false_alarms +=
        watched(before, relabelled(after), {.alarm = 0.05, .measures = {"settling_time"}}).state().alarm !=
                nullptr
            ? 1
            : 0;
    const auto unlabelled = [](std::string text) {
      text.replace(0, 11, "_,_________");
      return text;
    };
    without_labels +=
        watched(unlabelled(before), unlabelled(after), {.measures = {"settling_time"}}).state().alarm !=
                nullptr
            ? 1
            : 0;
  }
  EXPECT_LE(false_alarms, 6) << "at most 5 % are allowed";
  EXPECT_GE(without_labels, 20);
}

// Two peaks have no median: the one number would be that of either target, by chance.
TEST(Likes, HaveTheirOwnMediansWhereTheyDiffer) {
  random::NumberSource numbers = numbers_of("medians", 1);
  MachineMonitor machine = watched(log_of_program({}, 301, numbers), log_of_program({}, 300, numbers));
  const monitor::MeasureState& times = machine.measures()[0];
  EXPECT_FALSE(times.baseline_median);
  EXPECT_FALSE(times.median);
  ASSERT_EQ(times.by_like.size(), 2);
  EXPECT_EQ(times.by_like[0].like, "move 0, target 10");
  EXPECT_NEAR(times.by_like[0].baseline, 0.02, 0.001);
  EXPECT_NEAR(*times.by_like[1].median, 0.06, 0.003);
  EXPECT_EQ(times.by_like[0].baseline_moves, 151);
  EXPECT_EQ(times.by_like[1].moves, 150);
  EXPECT_TRUE(machine.measures()[1].by_like.empty()) << "torques in the direction of the move have one peak";
  EXPECT_NEAR(*machine.measures()[1].median, 0.3, 0.003);
}

TEST(Likes, AreNoEvidenceWhereTheProgramChanges) {
  random::NumberSource numbers = numbers_of("program", 1);
  MachineMonitor machine =
      watched(log_of_program({}, 200, numbers),
              log_of_program({.targets = {20.0, -20.0}, .medians = {0.05, 0.09}}, 200, numbers));
  EXPECT_EQ(machine.state().status, MachineStatus::undecided);
  EXPECT_EQ(machine.state().alarm, nullptr);
  EXPECT_EQ(machine.values(), 0);
  EXPECT_EQ(machine.unlike(), 200);
  EXPECT_EQ(machine.first_unlike(), "move 0, target 20");
  // Blocks and moves count the moves that are compared; their numbers stay those of the log.
  std::string mixed = log_of_program({.targets = {20.0}, .medians = {0.05}}, 50, numbers);
  const std::string rest = log_of_program({.time_factor = 1.5}, 200, numbers);
  mixed += rest.substr(rest.find('\n') + 1);
  MachineMonitor later = watched(log_of_program({}, 200, numbers), mixed);
  ASSERT_EQ(later.state().status, MachineStatus::changed);
  EXPECT_NEAR(static_cast<double>(*later.state().alarm->since), 51.0, 3.0);
  EXPECT_EQ(later.unlike(), 50);
}

TEST(Likes, AreToldByNumbersOfACycleAndNotByThoseOfALog) {
  const auto by = [](const std::string& before, const std::string& after) {
    return watched(before, after).likes().by();
  };
  std::string counted = "move,settling_time\n";
  std::string cycles = counted;
  std::string random_targets = "target,settling_time\n";
  for (int i = 0; i < 100; ++i) {
    counted += fmt::format("{},{}\n", i, 0.1 + 0.001 * (i % 7));
    cycles += fmt::format("{},{}\n", i % 4, 0.1 + 0.001 * (i % 7));
    random_targets += fmt::format("{},{}\n", std::sin(static_cast<double>(i)), 0.1 + 0.001 * (i % 7));
  }
  EXPECT_EQ(by(counted, counted), monitor::LikeBy::nothing);
  EXPECT_EQ(by(cycles, cycles), monitor::LikeBy::number);
  EXPECT_EQ(by(cycles, random_targets), monitor::LikeBy::nothing) << "no label is on both sides";
  EXPECT_EQ(by(random_targets, random_targets), monitor::LikeBy::direction);
}

TEST(Likes, KnowTargetsInOtherUnits) {
  std::string in_mm = "target [mm],settling_time\n";
  std::string in_m = "target [m],settling_time\n";
  for (int i = 0; i < 60; ++i) {
    in_mm += fmt::format("{},0.05\n", i % 2 == 0 ? 0.3 : -0.7);
    in_m += fmt::format("{},0.05\n", i % 2 == 0 ? 0.0003 : -0.0007);
  }
  MachineMonitor machine = watched(in_mm, in_m);
  EXPECT_EQ(machine.likes().by(), monitor::LikeBy::target);
  EXPECT_EQ(machine.unlike(), 0);
  std::string in_counts = in_m;
  in_counts.replace(0, 10, "target [count]");
  EXPECT_THROW(watched(in_mm, in_counts), Failure);
}

// Blocks of moves of several kinds are alike where they have the same kinds.
TEST(Likes, MakeBlocksOfTheSameKindsAlike) {
  random::NumberSource numbers = numbers_of("blocks", 1);
  const std::string before = log_of_program({}, 600, numbers);
  Program slower{.time_factor = 1.2};
  MachineMonitor machine = watched(before, log_of_program(slower, 600, numbers), {.block = 5});
  ASSERT_EQ(machine.state().status, MachineStatus::changed);
  EXPECT_EQ(*machine.state().alarm->direction, monitor::Direction::higher);
  EXPECT_EQ(machine.values(), 120);
}

}  // namespace
}  // namespace zerocount::testing
