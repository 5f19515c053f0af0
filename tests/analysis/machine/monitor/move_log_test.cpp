// Logs of moves as machines write them.
#include "analysis/machine/monitor/move_log.hpp"

#include "core/failure/failure.hpp"
#include "tests/analysis/machine/monitor/move_sequences.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Values = std::vector<double>;
constexpr double never = HUGE_VAL;

/// The message and the exit code with which a log is refused.
std::string refusal(std::string_view text) {
  try {
    log_of(text).require_header();
  } catch (const Failure& failure) {
    return std::to_string(static_cast<int>(failure.code())) + " " + failure.what();
  }
  return "";
}

TEST(MoveLog, ReadsMeasuresByNameWithBandsUnitsAndMissingValues) {
  const monitor::MoveLog log = log_of(
      "# axis 3\n"
      "move,arrival_time [ms],band_settling_time[1] [s],band_exits[2],outcome,stable,holding_torque (mN "
      "m)\r\n"
      "1,50,0.04,2,zero_count,yes,-2\r\n"
      "2,,NaN,0,1,0,1.5e1\r\n"
      "\r\n"
      "3,+75.5,inf,1,\"off_target\",True,NA\r\n");
  EXPECT_EQ(log.moves, 3);
  EXPECT_EQ(log.others(), std::vector<std::string>{"move"});
  EXPECT_EQ(log.find("arrival_time")->values, (Values{0.05, never, 0.0755}));
  EXPECT_EQ(log.find("band_settling_time[1]")->values, (Values{0.04, never, never}));
  EXPECT_EQ(log.find("band_exits[2]")->values, (Values{2.0, 0.0, 1.0}));
  EXPECT_EQ(log.find("outcome")->values, (Values{1.0, 0.0, 0.0})) << "whether it is zero_count";
  EXPECT_EQ(log.find("stable")->values, (Values{1.0, 0.0, 1.0}));
  EXPECT_EQ(log.find("holding_torque")->values, (Values{-0.002, 0.015, never}));
  EXPECT_EQ(log.find("band_settling_time[2]"), nullptr);
}

// A machine that begins to oscillate has a larger amplitude than before, and one that no longer arrives a
// smaller fraction of its time at zero.
TEST(MoveLog, AnEmptyCellRanksAsBetterOrWorseDependingOnTheMeasure) {
  const monitor::MoveLog log = log_of(
      "arrival_time,rest_error_rms,zero_fraction,arrival,oscillation_amplitude,jerk_agreement\n"
      "0.05,0.3,0.9,7,4,0.5\n,,,-1,,\n");
  for (const auto& [measure, missing] :
       {std::pair{"arrival_time", never}, std::pair{"rest_error_rms", never},
        std::pair{"zero_fraction", -never}, std::pair{"arrival", never},
        std::pair{"oscillation_amplitude", -never}, std::pair{"jerk_agreement", -never}}) {
    const monitor::Moves::Column& column = *log.find(measure);
    EXPECT_EQ(column.values.back(), missing) << measure;
    const bool is_nothing =
        column.measure.name == "oscillation_amplitude" || column.measure.name == "jerk_agreement";
    EXPECT_EQ(monitor::is_nothing(column.measure, column.values.back()), is_nothing) << measure;
    EXPECT_FALSE(monitor::is_nothing(column.measure, column.values.front())) << measure;
  }
}

TEST(MoveLog, TakesMagnitudesOfErrorsAndDecimalCommas) {
  const monitor::MoveLog log = log_of("final_error;arrival_time\n-3;0,05\n2;0,06\n");
  EXPECT_EQ(log.find("final_error")->values, (Values{3.0, 2.0}));
  EXPECT_EQ(log.find("arrival_time")->values, (Values{0.05, 0.06}));
}

// A machine that stopped settling writes empty fields until the end of its log.
TEST(MoveLog, ABlankLineOfASingleColumnIsAMoveThatNeverSettled) {
  const auto values = [](std::string_view text) { return log_of(text).find("arrival_time")->values; };
  EXPECT_EQ(values("arrival_time\n0.1\n\n0.2\n\"\"\n0.3"), (Values{0.1, never, 0.2, never, 0.3}));
  EXPECT_EQ(values("arrival_time\n0.1\n\n\n"), (Values{0.1, never, never}));
  EXPECT_EQ(values("arrival_time\n\n\n\n"), (Values{never, never, never}));
  EXPECT_EQ(values("arrival_time [ms]\r\n100\r\n\r\n  \r\n\t\r\n"), (Values{0.1, never, never, never}));
  EXPECT_EQ(values("\n# axis 3\n\narrival_time\n# first shift\n\n# second shift\n0.1\n"),
            (Values{never, 0.1}))
      << "before the header, and in comments, there are no rows";
}

TEST(MoveLog, TheLineFeedAfterTheLastRowIsNotARow) {
  for (const char* const end : {"", "\n", "\r\n", "\n ", "\r\n\r"})
    EXPECT_EQ(log_of(std::string("arrival_time\n0.1") + end).moves, 1) << ::testing::PrintToString(end);
  EXPECT_EQ(log_of("arrival_time\n").moves, 0);
  EXPECT_EQ(log_of("arrival_time").moves, 0);
}

// A measure that always has a value cannot be empty.
TEST(MoveLog, RefusesABlankLineIfTheSingleColumnCannotBeEmpty) {
  EXPECT_TRUE(says(refusal("outcome\nzero_count\n\n"), "4 moves.csv:3: outcome: ''; expected one of"));
}

// Whatever the number and the places of the empty rows, a log of one column has the same moves as with a
// second column beside it, in which rows have a separator.
TEST(MoveLog, HasTheSameMovesWithOneColumnAsWithSeveral) {
  random::NumberSource numbers = numbers_of("empty rows", 1);
  for (int log = 0; log < 50; ++log) {
    std::string one = "arrival_time\n";
    std::string two = "arrival_time,overshoot\n";
    for (int row = 0; row < 20; ++row) {
      const std::string cell = numbers.uniform() < 0.5 ? "" : fmt::format("{}", numbers.uniform());
      one += cell + "\n";
      two += cell + ",0\n";
    }
    EXPECT_EQ(log_of(one).find("arrival_time")->values, log_of(two).find("arrival_time")->values) << one;
  }
}

TEST(MoveLog, ReadsLinesOfSeparatorsAsMovesThatNeverSettled) {
  for (const char separator : {'\t', ';', ','}) {
    std::string text = "arrival_time,final_settling_time\n0.1,0.2\n,\n , \n  \n\n0.3,0.4\n";
    std::ranges::replace(text, ',', separator);
    EXPECT_EQ(log_of(text).find("arrival_time")->values, (Values{0.1, never, never, 0.3})) << separator;
  }
  EXPECT_EQ(log_of("arrival_time,final_settling_time\n\t\n1,2\n").moves, 1);
}

TEST(MoveLog, NamesBandsAndTolerancesAsTheProgramDoes) {
  const monitor::MoveLog log = log_of("band_settling_time[1.0],tolerance_settling_time[0.00000001]\n1,2\n");
  EXPECT_NE(log.find("band_settling_time[1]"), nullptr);
  EXPECT_NE(log.find("tolerance_settling_time[1e-08]"), nullptr);
  EXPECT_EQ(refusal("band_settling_time[1],band_settling_time[1.0]\n1,2\n"),
            "2 moves.csv:1: two columns are named 'band_settling_time[1]'");
  EXPECT_FALSE(monitor::measure_named("band_settling_time[1.5]"));
}

// Each measure in other letters is taken for itself, and for no other one.
TEST(MisspeltMeasure, IsMatchedByItsLetters) {
  study::StudyFeatures features;
  for (const layout::Measure& row : layout::measure_table(features)) {
    const std::string name = row.field.column.name;
    std::string upper = name;
    std::ranges::transform(upper, upper.begin(), [](char c) { return static_cast<char>(std::toupper(c)); });
    std::ranges::replace(upper, '_', '-');
    EXPECT_EQ(monitor::misspelt_measure(upper + " [s]"), name);
    EXPECT_EQ(monitor::resembling_column(name, std::vector<std::string>{"day", upper, name + "_2"}), upper);
  }
  EXPECT_EQ(monitor::misspelt_measure("Band Settling Time 12"), "band_settling_time[12]");
  for (const std::string other : {"day", "t", "", "time", "12", "settling"})
    EXPECT_FALSE(monitor::misspelt_measure(other)) << other;
  const std::string long_name = std::string(100, 'x') + "_arrival_time";
  EXPECT_EQ(monitor::resembling_column("arrival_time", std::vector<std::string>{long_name}), long_name);
  EXPECT_EQ(monitor::resembling_column(long_name, std::vector<std::string>{"t", "arrival_time"}),
            "arrival_time");
  EXPECT_FALSE(
      monitor::resembling_column("arrival_time", std::vector<std::string>{"day", "t", "", "x [mm]"}));
}

TEST(MoveLog, ReadsAGrowingLogInPieces) {
  for (const std::string text : {"t,arrival_time\n1,0.1\n2,\n\n3,0.3\n4,\n", "arrival_time\n0.1\n\n0.3\n\n"})
    for (std::size_t size = 1; size < text.size(); ++size) {
      monitor::MoveLog log("moves.csv");
      std::size_t read = 0;
      for (std::size_t end = size; end < text.size() + size; end += size)
        read += log.read(std::string_view(text).substr(0, std::min(end, text.size())).substr(read));
      EXPECT_EQ(log.find("arrival_time")->values, (Values{0.1, never, 0.3, never})) << size;
    }
}

TEST(MoveLog, UnreadableCellsAreRefusedWithTheirPlace) {
  EXPECT_EQ(
      refusal(""),
      "2 moves.csv: is empty; expected a header with names of measures, such as arrival_time, and a row "
      "for each move");
  EXPECT_TRUE(says(refusal("time,position\n1,2\n"), "2 moves.csv:1: no column is named like a measure"));
  EXPECT_TRUE(says(refusal("Day,Arrival-Time [ms]\n1,2\n"), "'Arrival-Time [ms]' looks like arrival_time"));
  EXPECT_EQ(refusal("arrival_time,arrival_time [ms]\n1,2\n"),
            "2 moves.csv:1: two columns are named 'arrival_time'");
  EXPECT_EQ(refusal("move,arrival_time,move\n0,1,0\n"), "2 moves.csv:1: two columns are named 'move'");
  EXPECT_EQ(refusal("t,arrival_time,t\n0,1,0\n"), "") << "other columns are not read";
  EXPECT_TRUE(says(refusal("arrival_time [N]\n1\n"), "2 moves.csv:1: arrival_time is in 'N'"));
  EXPECT_TRUE(says(refusal("overshoot [%]\n1\n"), "2 moves.csv:1: overshoot is in '%'"));
  EXPECT_EQ(refusal("overshoot [count],jerk_count [1],zero_fraction [%]\n1,2,3\n"), "");
  EXPECT_TRUE(says(refusal("arrival_time\r0.1\r0.2\r"), "2 moves.csv:1: a carriage return"));
  EXPECT_EQ(refusal("t,arrival_time\n1,0.1\n2\n"),
            "4 moves.csv:3: a row of 1 cells; expected 2, as the header has");
  EXPECT_EQ(refusal("t,arrival_time\n1,-0.1\n"),
            "4 moves.csv:2: arrival_time: '-0.1'; expected a finite time, not negative, or NaN");
  EXPECT_EQ(refusal("t,arrival_time\n1,soon\n"),
            "4 moves.csv:2: arrival_time: 'soon'; expected a finite time, not negative, or NaN");
  EXPECT_EQ(refusal("t,stable\n1,\n"), "4 moves.csv:2: stable: ''; expected 0 or 1");
  EXPECT_TRUE(says(refusal("t,outcome\n1,9\n"), "expected one of zero_count, one_count"));
}

}  // namespace
}  // namespace zerocount::testing
