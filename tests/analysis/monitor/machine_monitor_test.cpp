// A machine's moves beside those of its baseline.
#include "analysis/monitor/machine_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "tests/analysis/monitor/move_sequences.hpp"

namespace zerocount::testing {
namespace {

using monitor::Baseline;
using monitor::MachineMonitor;
using monitor::MachineStatus;
using monitor::MonitorSettings;
using monitor::MoveLog;

/// What an answer says of a log.
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

const std::string head = "settling_time";

std::string log_of_times(const std::vector<double>& values) {
  return log_text(head, values);
}

TEST(MachineMonitor, SeesAChangeOfEitherDirection) {
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
TEST(MachineMonitor, TellsNoChangeFromTooFewMoves) {
  const std::string before = log_of_times(times(1, 200));
  EXPECT_EQ(said_of(before, log_of_times(times(2, 300))).status, MachineStatus::unchanged);
  EXPECT_EQ(said_of(before, log_of_times(times(2, 15))).status, MachineStatus::undecided);
  EXPECT_EQ(said_of(before, log_of_times(times(2, 300)), {.change = 0.03}).status, MachineStatus::undecided);
  EXPECT_EQ(said_of(log_of_times(times(1, 5)), log_of_times(times(2, 300))).status, MachineStatus::undecided);
}

TEST(MachineMonitor, DecidesNothingWithoutMoves) {
  const Said said = said_of(log_of_times(times(1, 200)), head + "\n");
  EXPECT_EQ(said, (Said{MachineStatus::undecided, "", "", {}, {}, 0, 1.0}));
}

TEST(MachineMonitor, SaysTheSameOfABaselineInAnotherOrder) {
  std::vector<double> before = times(1, 200);
  const std::string after = log_of_times(times(2, 400, 200, 0.8));
  const Said said = said_of(log_of_times(before), after);
  std::ranges::reverse(before);
  EXPECT_EQ(said_of(log_of_times(before), after), said);
  std::ranges::sort(before);
  EXPECT_EQ(said_of(log_of_times(before), after), said);
}

TEST(MachineMonitor, SaysTheSameOfAMonotoneTransform) {
  const std::vector<double> before = times(1, 200);
  const std::vector<double> after = times(2, 400, 200, 0.8);
  const auto squares = [](std::vector<double> values) {
    for (double& value : values) value *= value;
    return log_of_times(values);
  };
  const Said said = said_of(log_of_times(before), log_of_times(after));
  EXPECT_EQ(said_of(squares(before), squares(after)), said);
}

TEST(MachineMonitor, SaysTheSameInOtherUnits) {
  std::vector<double> before = times(1, 200);
  std::string in_ms = "settling_time [ms]\n";
  for (const double value : before) in_ms += fmt::format("{}\n", 1e3 * value);
  const std::string after = log_text("settling_time [s]", times(2, 400, 200, 0.8));
  const Said said = said_of(log_of_times(before), after);
  EXPECT_EQ(said_of(in_ms, after).alarm_at, said.alarm_at);
}

TEST(MachineMonitor, SeesFewerGoodMovesAndMovesThatNeverSettle) {
  random::NumberSource numbers = numbers_of("qualities", 0);
  const auto log = [&](int moves, double good) {
    std::string text = "outcome,settling_time\n";
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
TEST(MachineMonitor, SaysTheSameWhileTheLogGrows) {
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
TEST(MachineMonitor, SharesTheFalseAlarmsAmongTheMeasures) {
  const auto log = [](const std::vector<double>& values, bool twice) {
    std::string text = twice ? "settling_time,final_settling_time\n" : "settling_time\n";
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
TEST(MachineMonitor, SaysWhereTheBaselineIsNotExchangeable) {
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
TEST(MachineMonitor, WatchesAccumulatingStatesOnlyWhereNamed) {
  const MoveLog log = log_of("creep,overshoot\n1e-6,1\n");
  const Baseline baseline = monitor::baseline_of(log);
  EXPECT_EQ(MachineMonitor(baseline, log, {}).measures().size(), 1);
  EXPECT_EQ(MachineMonitor(baseline, log, {}).unused(), std::vector<std::string>{"creep"});
  EXPECT_EQ(MachineMonitor(baseline, log, {.measures = {"creep"}}).measures().front().measure.name, "creep");
}

TEST(MachineMonitor, RefusesWhatCannotBeCompared) {
  const auto message = [](const std::string& before, const std::string& after,
                          const MonitorSettings& settings) {
    try {
      said_of(before, after, settings);
    } catch (const Failure& failure) {
      return std::string(failure.what());
    }
    return std::string();
  };
  EXPECT_EQ(
      message("overshoot\n1\n", "settling_time\n1\n", {}),
      "moves.csv: no measure to compare: it has settling_time, and baseline.csv has overshoot; expected "
      "columns named alike");
  EXPECT_EQ(message("overshoot\n1\n", "overshoot\n1\n", {.measures = {"stable"}}),
            "--measure stable: moves.csv has no such measure");
  EXPECT_EQ(message("overshoot\n", "overshoot\n1\n", {}),
            "baseline.csv: has no moves; expected a row for each move of the baseline");
  EXPECT_EQ(message("overshoot\n1\n", "overshoot\n1\n", {.block = 2}),
            "the baseline has 1 moves; expected at least a block of 2");
}

}  // namespace
}  // namespace zerocount::testing
