// A machine's moves beside those of its baseline.
#include "analysis/machine/monitor/machine_monitor.hpp"

#include <chrono>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/machine/monitor/monitor_baseline.hpp"
#include "tests/analysis/machine/monitor/move_sequences.hpp"
#include "tests/support/refusal.hpp"

namespace zerocount::testing {
namespace {

using monitor::Baseline;
using monitor::ChangeForm;
using monitor::Direction;
using monitor::MachineMonitor;
using monitor::MachineStatus;
using monitor::MonitorSettings;
using monitor::MoveLog;
using Directions = std::vector<Direction>;
using Values = std::vector<double>;

/// Answer of the monitor about a log of moves.
struct Said {
  MachineStatus status;
  std::string measure, direction;
  std::optional<std::int64_t> since, alarm_at;
  std::int64_t moves;
  double evidence;

  bool operator==(const Said&) const = default;
};

Said said_of(const std::string& before, const std::string& after, const MonitorSettings& settings = {}) {
  const MoveLog log = log_of(after);
  MachineMonitor machine(monitor::baseline_of(log_of(before, "baseline.csv")), log, settings);
  machine.update(log);
  const monitor::MonitorState state = machine.state();
  Said said{.status = state.status,
            .measure = "",
            .direction = "",
            .since = {},
            .alarm_at = {},
            .moves = state.moves,
            .evidence = state.evidence};
  if (state.alarm == nullptr) return said;
  said.measure = state.alarm->measure.name;
  said.direction = *state.alarm->direction == monitor::Direction::higher ? "higher" : "lower";
  said.since = state.alarm->since;
  said.alarm_at = state.alarm->alarm_at;
  return said;
}

std::vector<double> times(std::uint32_t number, std::int64_t moves, std::int64_t change = 0,
                          double factor = 1.0) {
  random::NumberSource numbers = numbers_of("times", number);
  std::vector<double> values;
  for (std::int64_t i = 1; i <= moves; ++i)
    values.push_back(move_value(Moves::lognormal, numbers, change > 0 && i >= change ? factor : 1.0));
  return values;
}

const std::string head = "arrival_time";

std::string log_of_times(const std::vector<double>& values) {
  return log_text(head, values);
}

TEST(MachineMonitor, FindsAChangeInEitherDirection) {
  const std::string before = log_of_times(times(1, 200));
  for (const double factor : {0.8, 1.25}) {
    const Said said = said_of(before, log_of_times(times(2, 1000, 301, factor)));
    EXPECT_EQ(said.status, MachineStatus::changed);
    EXPECT_EQ(said.direction, factor > 1.0 ? "higher" : "lower");
    EXPECT_EQ(said.measure, head);
    EXPECT_NEAR(static_cast<double>(*said.since), 301.0, 60.0);
    EXPECT_GT(*said.alarm_at, 301);
    EXPECT_LT(*said.alarm_at, 450);
    EXPECT_GE(said.evidence, 1000.0);
    EXPECT_EQ(said.moves, 1000);
  }
}

// 20 % of the median are seen within some 60 moves, so 300 moves show that there was no such change.
TEST(MachineMonitor, DistinguishesNoChangeFromTooFewMoves) {
  const std::string before = log_of_times(times(1, 200));
  EXPECT_EQ(said_of(before, log_of_times(times(2, 300))).status, MachineStatus::unchanged);
  EXPECT_EQ(said_of(before, log_of_times(times(2, 15))).status, MachineStatus::undecided);
  EXPECT_EQ(said_of(before, log_of_times(times(2, 300)), {.change = 0.03}).status, MachineStatus::undecided);
  EXPECT_EQ(said_of(log_of_times(times(1, 5)), log_of_times(times(2, 300))).status, MachineStatus::undecided);
}

TEST(MachineMonitor, IsUndecidedWithoutMoves) {
  const Said said = said_of(log_of_times(times(1, 200)), head + "\n");
  EXPECT_EQ(said, (Said{MachineStatus::undecided, "", "", {}, {}, 0, 1.0}));
}

TEST(MachineMonitor, DoesNotDependOnTheOrderOfTheBaseline) {
  std::vector<double> before = times(1, 200);
  const std::string after = log_of_times(times(2, 400, 200, 0.8));
  const Said said = said_of(log_of_times(before), after);
  std::ranges::reverse(before);
  EXPECT_EQ(said_of(log_of_times(before), after), said);
  std::ranges::sort(before);
  EXPECT_EQ(said_of(log_of_times(before), after), said);
}

TEST(MachineMonitor, IsInvariantUnderMonotoneTransforms) {
  const std::vector<double> before = times(1, 200);
  const std::vector<double> after = times(2, 400, 200, 0.8);
  const auto squares = [](std::vector<double> values) {
    for (double& value : values) value *= value;
    return log_of_times(values);
  };
  const Said said = said_of(log_of_times(before), log_of_times(after));
  EXPECT_EQ(said_of(squares(before), squares(after)), said);
}

TEST(MachineMonitor, DoesNotDependOnTheUnits) {
  std::vector<double> before = times(1, 200);
  std::string in_ms = "arrival_time [ms]\n";
  for (const double value : before) in_ms += fmt::format("{}\n", 1e3 * value);
  const std::string after = log_text("arrival_time [s]", times(2, 400, 200, 0.8));
  const Said said = said_of(log_of_times(before), after);
  EXPECT_EQ(said_of(in_ms, after).alarm_at, said.alarm_at);
}

TEST(MachineMonitor, FindsFewerGoodMovesAndMovesThatNeverSettle) {
  random::NumberSource numbers = numbers_of("qualities", 0);
  const auto log = [&](int moves, double good) {
    std::string text = "outcome,arrival_time\n";
    for (int i = 0; i < moves; ++i) {
      const bool is_good = numbers.uniform() < good;
      text += fmt::format("{},{}\n", is_good ? "zero_count" : "one_count",
                          is_good ? fmt::format("{}", move_value(Moves::lognormal, numbers)) : "");
    }
    return text;
  };
  const std::string before = log(1000, 0.97);
  const Said said = said_of(before, log(600, 0.8));
  EXPECT_EQ(said.status, MachineStatus::changed);
  EXPECT_TRUE(said.measure == "outcome" ? said.direction == "lower" : said.direction == "higher");
  EXPECT_EQ(said_of(before, log(600, 0.97)).status, MachineStatus::unchanged);
}

// What a prefix of the log says does not depend on what follows, however the log is read.
TEST(MachineMonitor, AGrowingLogGivesTheSameAnswerAsTheWholeLog) {
  const std::string before = log_of_times(times(1, 200));
  const std::vector<double> moves = times(2, 260, 150, 0.75);
  MoveLog log = log_of(head + "\n");
  MachineMonitor machine(monitor::baseline_of(log_of(before)), log, {});
  for (std::size_t i = 0; i < moves.size(); ++i) {
    log.read(fmt::format("{}\n", moves[i]));
    machine.update(log);
    if (i % 20 != 0) continue;
    const monitor::MonitorState state = machine.state();
    const Said said =
        said_of(before, log_of_times({moves.begin(), moves.begin() + static_cast<std::ptrdiff_t>(i) + 1}));
    EXPECT_EQ(state.status, said.status) << i;
    EXPECT_EQ(state.evidence, said.evidence) << i;
    EXPECT_EQ(state.alarm == nullptr ? std::nullopt : state.alarm->since, said.since) << i;
  }
}

// Each of K measures has the alarm at K/alarm, however they depend on each other.
TEST(MachineMonitor, DividesTheFalseAlarmProbabilityAmongTheMeasures) {
  const auto log = [](const std::vector<double>& values, bool twice) {
    std::string text = twice ? "arrival_time,final_settling_time\n" : "arrival_time\n";
    for (const double value : values)
      text += twice ? fmt::format("{},{}\n", value, 2.0) : fmt::format("{}\n", value);
    return text;
  };
  const std::vector<double> before = times(1, 200);
  const std::vector<double> after = times(2, 400, 200, 0.8);
  const Said one = said_of(log(before, false), log(after, false), {.alarm = 0.0005});
  const Said two = said_of(log(before, true), log(after, true), {.alarm = 0.001});
  EXPECT_EQ(one.alarm_at, two.alarm_at);
  EXPECT_NEAR(one.evidence, 2.0 * two.evidence, 1e-9 * one.evidence);
}

TEST(MachineMonitor, CountsBlocksInMoves) {
  const std::vector<double> before = times(1, 600);
  const Said said = said_of(log_of_times(before), log_of_times(times(2, 1002, 501, 0.8)), {.block = 5});
  EXPECT_EQ(said.status, MachineStatus::changed);
  EXPECT_EQ(*said.alarm_at % 5, 0);
  EXPECT_EQ(*said.since % 5, 1);
  EXPECT_EQ(said.moves, 1002);
  // A block of one is a move, and blocks of medians are the values that they are.
  std::vector<double> tripled;
  for (const double value : before)
    for (int i = 0; i < 3; ++i) tripled.push_back(value);
  const std::vector<double> moves = times(2, 300, 100, 0.8);
  std::vector<double> moves_tripled;
  for (const double value : moves)
    for (int i = 0; i < 3; ++i) moves_tripled.push_back(value);
  EXPECT_EQ(said_of(log_of_times(tripled), log_of_times(moves_tripled), {.block = 3}).evidence,
            said_of(log_of_times(before), log_of_times(moves)).evidence);
}

// Values that wander are not exchangeable; their blocks are, nearly.
TEST(MachineMonitor, ReportsABaselineThatIsNotExchangeable) {
  random::NumberSource numbers = numbers_of("wander", 0);
  std::vector<double> values;
  double wander = 0.0;
  for (int i = 0; i < 2000; ++i) {
    wander = 0.6 * wander + numbers.normal();
    values.push_back(std::exp(0.1 * wander));
  }
  const auto dependent = [](const std::vector<double>& baseline, std::int64_t block) {
    const MoveLog log = log_of(head + "\n");
    std::vector<std::string> names;
    const MachineMonitor machine(monitor::baseline_of(log_of(log_of_times(baseline))), log, {.block = block});
    for (const monitor::MeasureState* const state : machine.dependent()) names.push_back(state->measure.name);
    return names;
  };
  EXPECT_NEAR(monitor::serial_correlation(values), 0.6, 0.05);
  EXPECT_EQ(dependent(values, 1), std::vector{head});
  EXPECT_TRUE(dependent(values, 20).empty());
  EXPECT_TRUE(dependent(times(1, 2000), 1).empty());
  EXPECT_EQ(monitor::serial_correlation(std::vector<double>{1.0, 1.0, 1.0}), 0.0);
}

// What accumulates in a simulated contact differs from its beginning on, in any machine.
TEST(MachineMonitor, WatchesAccumulatingStatesOnlyIfNamed) {
  const MoveLog log = log_of("creep,overshoot\n1e-6,1\n");
  const Baseline baseline = monitor::baseline_of(log);
  EXPECT_EQ(MachineMonitor(baseline, log, {}).measures().size(), 1);
  EXPECT_EQ(MachineMonitor(baseline, log, {}).unused(), std::vector<std::string>{"creep"});
  EXPECT_EQ(MachineMonitor(baseline, log, {.measures = {"creep"}}).measures().front().measure.name, "creep");
}

TEST(MachineMonitor, RefusesLogsThatCannotBeCompared) {
  const auto message = [](const std::string& before, const std::string& after,
                          const MonitorSettings& settings, ExitCode code = ExitCode::bad_input) {
    return refusal_by([&] { said_of(before, after, settings); }, code);
  };
  EXPECT_EQ(message("overshoot\n1\n", "arrival_time\n1\n", {}),
            "moves.csv: no measure to compare: it has arrival_time, and baseline.csv has overshoot; expected "
            "columns named alike");
  EXPECT_EQ(message("overshoot\n1\n", "overshoot\n1\n", {.measures = {"stable"}}),
            "--measure stable: moves.csv has no such measure");
  EXPECT_EQ(message("stable\n1\n", "Stable,overshoot\n1,1\n", {.measures = {"stable"}}),
            "--measure stable: moves.csv has no such measure; its column 'Stable' looks like it");
  EXPECT_TRUE(says(message("overshoot\n1\n", "arrival_time,Overshoot\n1,1\n", {}), "no measure to compare",
                   "the column 'Overshoot' of moves.csv looks like overshoot"));
  EXPECT_TRUE(says(message("creep\n1e-6\n", "creep\n1e-6\n", {}), "no measure to compare",
                   "creep is compared only where --measure names it"));
  EXPECT_EQ(message("overshoot\n", "overshoot\n1\n", {}, ExitCode::bad_data),
            "baseline.csv: has no moves; expected a row for each move of the baseline");
  EXPECT_EQ(message("overshoot\n1\n", "overshoot\n1\n", {.block = 2}, ExitCode::bad_data),
            "the baseline has 1 moves; expected at least a block of 2");
}

/// Names of the measures that are not watched for this reason, each with the column of the log that is like
/// it.
std::vector<std::string> unwatched(const std::string& before, const std::string& after,
                                   monitor::WhyUnwatched why, const MonitorSettings& settings = {}) {
  const MachineMonitor machine(monitor::baseline_of(log_of(before, "baseline.csv")), log_of(after), settings);
  std::vector<std::string> names;
  for (const monitor::UnwatchedMeasure& one : machine.unwatched())
    if (one.why == why) names.push_back(one.near ? one.measure + " " + *one.near : one.measure);
  return names;
}

using Names = std::vector<std::string>;

TEST(MachineMonitor, NamesEachMeasureOfTheBaselineThatTheMovesLack) {
  using enum monitor::WhyUnwatched;
  const std::string before = "arrival_time,overshoot,jerk_count\n0.1,1,0\n0.2,2,0\n";
  EXPECT_EQ(unwatched(before, "arrival_time,overshoot\n0.1,1\n", missing), Names{"jerk_count"});
  for (const std::string head :
       {"Arrival_Time", "ARRIVAL_TIME [ms]", "arrival time", "ArrivalTime", "arrival_time_ms", "arival_time"})
    EXPECT_EQ(unwatched(before, "overshoot,jerk_count," + head + "\n1,0,0.1\n", missing),
              Names{"arrival_time " + head});
  EXPECT_EQ(unwatched(before, "overshoot,jerk_count,day\n1,0,0.1\n", missing), Names{"arrival_time"});
  EXPECT_EQ(unwatched("band_settling_time[1],overshoot\n0.1,1\n", "band_settling_time[2],overshoot\n0.1,1\n",
                      missing),
            Names{"band_settling_time[1] band_settling_time[2]"});
  EXPECT_TRUE(unwatched(before, before, missing).empty());
  EXPECT_TRUE(unwatched(before, "overshoot\n1\n", missing, {.measures = {"overshoot"}}).empty())
      << "the others are not asked for";
}

TEST(MachineMonitor, NamesMeasuresThatTheBaselineLacks) {
  using enum monitor::WhyUnwatched;
  const std::string after = "arrival_time,overshoot\n0.1,1\n";
  EXPECT_EQ(unwatched("Arrival_Time,overshoot\n0.1,1\n", after, not_in_baseline),
            Names{"arrival_time Arrival_Time"});
  EXPECT_EQ(unwatched("overshoot\n1\n", after, not_in_baseline), Names{"arrival_time"});
  const std::string grows = "creep,overshoot\n1e-6,1\n";
  EXPECT_EQ(unwatched(grows, grows, accumulates), Names{"creep"});
}

// Without the column on both sides moves of all kinds are compared with each other, which is said.
TEST(MachineMonitor, NamesLabelsThatOneSideLacks) {
  const auto labels = [](const std::string& before, const std::string& after) {
    const MachineMonitor machine(monitor::baseline_of(log_of(before, "baseline.csv")), log_of(after), {});
    std::vector<std::string> names;
    for (const monitor::UnwatchedMeasure& label : machine.unused_labels())
      names.push_back(label.measure +
                      (label.why == monitor::WhyUnwatched::missing ? " of baseline " : " of moves ") +
                      label.near.value_or(""));
    return names;
  };
  const std::string with = "move,target,overshoot\n0,5,1\n";
  EXPECT_EQ(labels(with, "move,Target [rad],overshoot\n0,5,1\n"), Names{"target of baseline Target [rad]"});
  EXPECT_EQ(labels(with, "overshoot\n1\n"), (Names{"move of baseline ", "target of baseline "}));
  EXPECT_EQ(labels("overshoot,MOVE\n1,0\n", "move,overshoot\n0,1\n"), Names{"move of moves MOVE"});
  EXPECT_TRUE(labels(with, with).empty());
  EXPECT_TRUE(labels("overshoot\n1\n", "overshoot\n1\n").empty());
}

// Moves beside those that are like them.

/// A monitor that has seen all moves of a log.
MachineMonitor watched(const std::string& before, const std::string& after,
                       const MonitorSettings& settings = {}) {
  const monitor::MoveLog log = log_of(after);
  MachineMonitor machine(monitor::baseline_of(log_of(before, "baseline.csv")), log, settings);
  machine.update(log);
  return machine;
}

/// Moves that visit the targets in turn. The settling times of each target are distributed about its own
/// median. The holding torques act against friction, in the direction of the move.
struct Program {
  std::vector<double> targets{10.0, -10.0};
  std::vector<double> medians{0.02, 0.06};
  double time_factor{1.0};
  double torque_factor{1.0};
  bool shuffled{false};
};

std::string log_of_program(const Program& program, int moves, random::NumberSource& numbers,
                           const std::string& head = "move,target,arrival_time,holding_torque") {
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
TEST(MoveKinds, SignedMeasuresAreTakenInTheDirectionOfTheMove) {
  for (const char* const head : {"move,target,arrival_time,holding_torque",
                                 "move,arrival_time,holding_torque", "target,arrival_time,holding_torque"})
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
TEST(MoveKinds, AnotherMixtureOfMovesIsNotAChange) {
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
        watched(before, relabelled(after), {.alarm = 0.05, .measures = {"arrival_time"}}).state().alarm !=
                nullptr
            ? 1
            : 0;
    const auto unlabelled = [](std::string text) {
      text.replace(0, 11, "_,_________");
      return text;
    };
    without_labels +=
        watched(unlabelled(before), unlabelled(after), {.measures = {"arrival_time"}}).state().alarm !=
                nullptr
            ? 1
            : 0;
  }
  EXPECT_LE(false_alarms, 6) << "at most 5 % are allowed";
  EXPECT_GE(without_labels, 20);
}

// Two peaks have no median: the one number would be that of either target, by chance.
TEST(MoveKinds, KindsThatDifferHaveTheirOwnMedians) {
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

TEST(MoveKinds, MovesOfANewProgramAreNotCompared) {
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

TEST(MoveKinds, NumbersOfACycleDistinguishThemButRowNumbersDoNot) {
  const auto by = [](const std::string& before, const std::string& after) {
    return watched(before, after).likes().by();
  };
  std::string counted = "move,arrival_time\n";
  std::string cycles = counted;
  std::string random_targets = "target,arrival_time\n";
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

TEST(MoveKinds, TargetsInOtherUnitsMatch) {
  std::string in_mm = "target [mm],arrival_time\n";
  std::string in_m = "target [m],arrival_time\n";
  for (int i = 0; i < 60; ++i) {
    in_mm += fmt::format("{},0.05\n", i % 2 == 0 ? 0.3 : -0.7);
    in_m += fmt::format("{},0.05\n", i % 2 == 0 ? 0.0003 : -0.0007);
  }
  MachineMonitor machine = watched(in_mm, in_m);
  EXPECT_EQ(machine.likes().by(), monitor::LikeBy::target);
  EXPECT_EQ(machine.unlike(), 0);
  // A target is named in the unit in which it is kept.
  EXPECT_EQ(machine.likes().name_of({.target = 0.0003, .direction = 1}), "target 0.0003 m upwards");
  std::string in_counts = in_m;
  in_counts.replace(0, 10, "target [count]");
  EXPECT_THROW(watched(in_mm, in_counts), Failure);
}

// Blocks of moves of several kinds are alike where they have the same kinds.
TEST(MoveKinds, BlocksWithTheSameKindsAreComparable) {
  random::NumberSource numbers = numbers_of("blocks", 1);
  const std::string before = log_of_program({}, 600, numbers);
  Program slower{.time_factor = 1.2};
  MachineMonitor machine = watched(before, log_of_program(slower, 600, numbers), {.block = 5});
  ASSERT_EQ(machine.state().status, MachineStatus::changed);
  EXPECT_EQ(*machine.state().alarm->direction, monitor::Direction::higher);
  EXPECT_EQ(machine.values(), 120);
}

// The moves after which a change would have been seen.

/// A simulated change of a measure whose values are all alike.
struct Change {
  double size;
  Directions directions;
};

monitor::MonitoredMeasure measure(std::string_view name) {
  return *monitor::measure_named(name);
}

Change change_to_see(const monitor::MonitoredMeasure& measure, const Values& values,
                     std::optional<double> change) {
  const monitor::ChangeToSee to_see = monitor::change_to_see(measure, std::vector<Values>{values}, change);
  return {to_see.sizes.at(0), to_see.directions};
}

TEST(ChangeToDetect, IsAFractionOfTheMedianOrOfAProportion) {
  const Directions both{Direction::higher, Direction::lower};
  const Change time = change_to_see(measure("arrival_time"), Values{0.04, 0.05, 0.06}, {});
  EXPECT_NEAR(time.size, 0.01, 1e-15);
  EXPECT_EQ(time.directions, both);
  EXPECT_NEAR(change_to_see(measure("arrival_time"), Values{0.05}, 0.5).size, 0.025, 1e-15);
  const Change large = change_to_see(measure("arrival_time"), Values{0.04, 0.05, 0.06}, 1.5);
  EXPECT_NEAR(large.size, 0.075, 1e-15);
  EXPECT_EQ(large.directions, Directions{Direction::higher}) << "no time is negative";
  const Change good = change_to_see(measure("outcome"), Values{1.0, 1.0, 1.0, 0.0}, {});
  EXPECT_EQ(good.size, 0.1);
  EXPECT_EQ(good.directions, both);
  EXPECT_EQ(change_to_see(measure("stable"), Values{1.0}, {}).directions, Directions{Direction::lower});
}

TEST(ChangeToDetect, MeasuresWithoutAScaleHaveNone) {
  EXPECT_TRUE(change_to_see(measure("holding_torque"), Values{-1.0, 1.0, 2.0}, {}).directions.empty());
  EXPECT_TRUE(change_to_see(measure("arrival_time"), Values{1.0, HUGE_VAL, HUGE_VAL}, {}).directions.empty());
  EXPECT_TRUE(change_to_see(measure("jerk_count"), Values{0.0, 0.0, 3.0}, {}).directions.empty());
  EXPECT_FALSE(change_to_see(measure("holding_torque"), Values{1.0, 1.0, 2.0}, {}).directions.empty());
}

// Of a move to a far target a fifth is more than of one to a near target.
TEST(ChangeToDetect, IsAFractionOfTheMedianOfEachClass) {
  const std::vector<Values> classes{{0.02, 0.02, 0.03}, {0.2}, {HUGE_VAL}};
  const monitor::ChangeToSee to_see = monitor::change_to_see(measure("arrival_time"), classes, {});
  ASSERT_EQ(to_see.sizes.size(), 3);
  EXPECT_NEAR(to_see.sizes[0], 0.004, 1e-15);
  EXPECT_NEAR(to_see.sizes[1], 0.04, 1e-15);
  EXPECT_EQ(to_see.sizes[2], 0.0) << "what never happens cannot change so much";
  EXPECT_EQ(to_see.directions.size(), 2);
}

std::optional<std::int64_t> asked(const Values& baseline, Direction direction, double size,
                                  double alarm = 1000.0, std::string_view name = "arrival_time",
                                  ChangeForm form = ChangeForm::shift) {
  const monitor::MonitoredMeasure of = measure(name);
  const std::vector<Values> classes{baseline};
  const Values sizes{size};
  return monitor::values_to_see({.measure = of,
                                 .baseline = classes,
                                 .direction = direction,
                                 .form = form,
                                 .sizes = sizes,
                                 .alarm = alarm,
                                 .max_values = 2000,
                                 .seed = 1});
}

Values sorted_values(Moves kind, std::int64_t count, std::uint32_t number) {
  random::NumberSource numbers = numbers_of("delays", number);
  Values values;
  for (std::int64_t i = 0; i < count; ++i) values.push_back(move_value(kind, numbers));
  std::ranges::sort(values);
  return values;
}

TEST(ValuesToDetect, SmallerChangesAndRarerAlarmsNeedMoreValues) {
  const Values baseline = sorted_values(Moves::lognormal, 300, 1);
  const std::int64_t usual = asked(baseline, Direction::lower, 0.01).value();
  EXPECT_LT(asked(baseline, Direction::lower, 0.02).value(), usual);
  EXPECT_GT(asked(baseline, Direction::lower, 0.01, 1e6).value(), usual);
  EXPECT_FALSE(asked(baseline, Direction::lower, 0.0005));
  EXPECT_FALSE(asked(sorted_values(Moves::lognormal, 4, 2), Direction::lower, 0.01));
}

// A real sequence with that change, of the distribution that the baseline came from, is seen as often.
TEST(ValuesToDetect, SimulatedSequencesAlarmWithinThem) {
  for (const Moves kind : {Moves::lognormal, Moves::binary}) {
    const Values baseline = sorted_values(kind, 500, 3);
    const double size = kind == Moves::binary ? 0.1 : 0.01;
    const std::string_view name = kind == Moves::binary ? "stable" : "arrival_time";
    const std::int64_t values = asked(baseline, Direction::lower, size, 1000.0, name).value();
    int seen = 0;
    constexpr int sequences = 200;
    for (std::uint32_t i = 0; i < sequences; ++i) {
      random::NumberSource numbers = numbers_of("real", i);
      monitor::ChangeTest test({sorted_values(kind, 500, 100 + i)}, {5, 6});
      for (std::int64_t t = 0; t < values && test.martingale().capital() < 1000.0; ++t) {
        const double before = move_value(kind, numbers, kind == Moves::binary ? 0.85 / 0.95 : 1.0);
        test.update(kind == Moves::binary ? before : before - size);
      }
      seen += test.martingale().capital() >= 1000.0 ? 1 : 0;
    }
    EXPECT_GE(seen, 0.83 * sequences) << name_of(kind);
    EXPECT_LE(seen, 0.98 * sequences) << name_of(kind);
  }
}

// Half of the values of a skewed measure lie far below the median. A factor hardly moves them, a shift does.
TEST(ValuesToDetect, AFactorOnASkewedMeasureNeedsMoreThanAShift) {
  random::NumberSource numbers = numbers_of("skewed", 1);
  Values baseline;
  for (int i = 0; i < 400; ++i) baseline.push_back(0.05 * std::pow(-std::log(numbers.uniform()), 1.0 / 0.7));
  std::ranges::sort(baseline);
  const double size = 0.8 * baseline[200];
  const std::int64_t shifted = asked(baseline, Direction::higher, size).value();
  const std::int64_t multiplied =
      asked(baseline, Direction::higher, size, 1000.0, "arrival_time", ChangeForm::factor).value();
  EXPECT_GT(multiplied, 2 * shifted);
  EXPECT_EQ(monitor::forms_of(measure("arrival_time")).size(), 2);
  EXPECT_EQ(monitor::forms_of(measure("stable")).size(), 1) << "a proportion is changed by an amount";
}

// The promise of `unchanged`: where a change is there from the first move on, at most one machine in ten is
// called unchanged before the alarm.

enum class Population { weibull, exponential, lognormal, normal, bimodal };

double value_from(Population population, random::NumberSource& numbers) {
  switch (population) {
    case Population::weibull:
      return 0.05 * std::pow(-std::log(numbers.uniform()), 1.0 / 0.7);
    case Population::exponential:
      return -0.05 * std::log(numbers.uniform());
    case Population::lognormal:
      return 0.05 * std::exp(0.8 * numbers.normal());
    case Population::normal:
      return 0.05 * (1.0 + 0.1 * numbers.normal());
    case Population::bimodal:
      return (numbers.uniform() < 0.5 ? 0.03 : 0.07) * (1.0 + 0.05 * numbers.normal());
  }
  return 0.0;
}

struct Trap {
  Population population;
  ChangeForm form;
  double change;  ///< change as a fraction of the median, as in --change
  int baseline;   ///< number of moves of the baseline
  int machines;
  std::uint64_t seed;
};

/// Number of moves after which a machine without an alarm is called unchanged; empty if more moves are needed
/// than the test allows.
std::optional<std::int64_t> promised_after(const Values& baseline, double change, std::uint64_t seed) {
  const monitor::MonitoredMeasure of = measure("arrival_time");
  const std::vector<Values> classes{baseline};
  const monitor::ChangeToSee to_see = monitor::change_to_see(of, classes, change);
  std::int64_t promised = 0;
  for (const Direction direction : to_see.directions)
    for (const ChangeForm form : monitor::forms_of(of)) {
      const std::optional<std::int64_t> seen = monitor::values_to_see({.measure = of,
                                                                       .baseline = classes,
                                                                       .direction = direction,
                                                                       .form = form,
                                                                       .sizes = to_see.sizes,
                                                                       .alarm = 1000.0,
                                                                       .max_values = 512,
                                                                       .seed = seed});
      if (!seen) return std::nullopt;
      promised = std::max(promised, *seen);
    }
  return promised;
}

/// Number of simulated machines that have changed and are called unchanged before an alarm.
int called_unchanged(const Trap& trap) {
  int wrong = 0;
  for (int machine = 0; machine < trap.machines; ++machine) {
    random::NumberSource numbers = numbers_of(
        fmt::format("promise.{}.{}.{}", static_cast<int>(trap.population), trap.seed, trap.baseline),
        static_cast<std::uint32_t>(machine));
    const auto draw = [&](int count) {
      Values values;
      for (int i = 0; i < count; ++i) values.push_back(value_from(trap.population, numbers));
      std::ranges::sort(values);
      return values;
    };
    const Values baseline = draw(trap.baseline);
    const double shift = trap.form == ChangeForm::shift ? trap.change * draw(2001)[1000] : 0.0;
    const double factor = trap.form == ChangeForm::factor ? 1.0 + trap.change : 1.0;
    const std::optional<std::int64_t> promised = promised_after(baseline, trap.change, trap.seed);
    if (!promised) continue;
    monitor::ChangeTest test({baseline}, {7, static_cast<std::uint32_t>(machine)});
    while (test.martingale().values() < *promised && test.martingale().capital() < 1000.0)
      test.update(factor * value_from(trap.population, numbers) + shift);
    wrong += test.martingale().capital() < 1000.0 ? 1 : 0;
  }
  return wrong;
}

/// Upper limit of the number of changed machines that are called unchanged by chance, if each has the
/// probability 10 %: it is exceeded with at most the probability `level`.
int most_by_chance(int machines, double level) {
  int most = 0;
  while (statistics::binomial_upper_tail(machines, 0.1, most) > level) ++most;
  return most;
}

TEST(UnchangedVerdict, IsGivenToAtMostOneChangedMachineInTen) {
  for (const ChangeForm form : {ChangeForm::shift, ChangeForm::factor})
    for (const Population population : {Population::weibull, Population::normal}) {
      const Trap trap{population, form, 0.6, 150, 30, 1};
      EXPECT_LE(called_unchanged(trap), most_by_chance(trap.machines, 1e-3))
          << static_cast<int>(population) << " " << static_cast<int>(form);
    }
}

TEST(UnchangedVerdict, DISABLED_IsGivenToAtMostOneChangedMachineInTenOfAnyPopulation) {
  const auto night = static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch() /
                                                std::chrono::hours(24));
  for (const ChangeForm form : {ChangeForm::shift, ChangeForm::factor})
    for (const Population population : {Population::weibull, Population::exponential, Population::lognormal,
                                        Population::normal, Population::bimodal})
      for (const int baseline : {60, 200, 500}) {
        const Trap trap{population, form, population == Population::normal ? 0.05 : 0.3,
                        baseline,   100,  night};
        const int wrong = called_unchanged(trap);
        EXPECT_LE(wrong, most_by_chance(trap.machines, 1e-4))
            << static_cast<int>(population) << " " << static_cast<int>(form) << " after " << baseline
            << " moves, seed " << night;
      }
}

}  // namespace
}  // namespace zerocount::testing
