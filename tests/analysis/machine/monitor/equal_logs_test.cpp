// Logs of one machine under several names.
#include "analysis/machine/monitor/equal_logs.hpp"

#include "tests/analysis/machine/monitor/move_sequences.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// Settling times and final errors of a number of moves, to be written as a log.
struct LoggedMoves {
  std::vector<double> times;
  std::vector<int> errors;
};

LoggedMoves random_run(std::uint32_t number, int moves) {
  random::NumberSource numbers = numbers_of("equal logs", number);
  LoggedMoves run;
  for (int i = 0; i < moves; ++i) {
    run.times.push_back(0.03 + 0.02 * numbers.uniform());
    run.errors.push_back(static_cast<int>(7.0 * numbers.uniform()) - 3);
  }
  return run;
}

std::string plain(const LoggedMoves& run) {
  std::string text = "arrival_time,final_error\n";
  for (std::size_t i = 0; i < run.times.size(); ++i)
    text += fmt::format("{},{}\n", run.times[i], run.errors[i]);
  return text;
}

/// The text of a log with the same moves written differently: in ms, in other columns and with decimal
/// commas.
std::string otherwise(const LoggedMoves& run) {
  std::string text = "\xEF\xBB\xBF# machine 7\r\nserial;final_error;arrival_time [ms]\r\n";
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    std::string time = fmt::format("{:.12e}", 1e3 * run.times[i]);
    std::ranges::replace(time, '.', ',');
    text += fmt::format("{};{}.0;{}\r\n", i, run.errors[i], time);
  }
  return text;
}

LoggedMoves first_moves(LoggedMoves run, std::size_t moves) {
  run.times.resize(moves);
  run.errors.resize(moves);
  return run;
}

std::int64_t equal_moves_of(const std::string& one, const std::string& other) {
  const std::int64_t moves = monitor::equal_moves(log_of(one), log_of(other));
  EXPECT_EQ(monitor::equal_moves(log_of(other), log_of(one)), moves) << "whichever comes first";
  return moves;
}

TEST(EqualLogs, NotationDoesNotMatter) {
  for (std::uint32_t number = 0; number < 20; ++number) {
    const LoggedMoves run = random_run(number, 50);
    EXPECT_EQ(equal_moves_of(plain(run), plain(run)), 50);
    EXPECT_EQ(equal_moves_of(plain(run), otherwise(run)), 50);
    EXPECT_EQ(equal_moves_of(plain(run), otherwise(first_moves(run, 30))), 30) << "a copy that grew";
  }
}

TEST(EqualLogs, OneMoveOrTheOrderMakesThemDiffer) {
  for (std::uint32_t number = 0; number < 20; ++number) {
    const LoggedMoves run = random_run(number, 50);
    LoggedMoves other = run;
    other.times[number] *= 1.0 + 1e-6;
    EXPECT_EQ(equal_moves_of(plain(run), plain(other)), 0);
    LoggedMoves turned = run;
    std::ranges::reverse(turned.times);
    EXPECT_EQ(equal_moves_of(plain(run), plain(turned)), 0);
    LoggedMoves mirrored = run;
    for (int& error : mirrored.errors) error = -error;
    EXPECT_EQ(equal_moves_of(plain(run), plain(mirrored)), 0) << "errors have signs";
    EXPECT_EQ(equal_moves_of(plain(run), plain(random_run(number + 100, 50))), 0);
  }
}

// Two machines of the same length with few quantised values are taken for one: the user tells them apart. A
// shorter log that is the beginning of a longer one by chance is not.
TEST(EqualLogs, LogsWithFewDifferentValuesMustHaveTheSameLength) {
  const std::string five = "outcome\n0\n0\n1\n0\n0\n";
  EXPECT_EQ(equal_moves_of(five, five), 5);
  EXPECT_EQ(equal_moves_of(five, five + "0\n0\n"), 0);
  EXPECT_EQ(equal_moves_of("arrival_time\n0.1\n", "arrival_time\n0.1\n0.2\n"), 0);
  EXPECT_EQ(equal_moves_of(five, "overshoot\n0\n0\n1\n0\n0\n"), 0) << "no measure in common";
}

TEST(EqualLogs, AllEqualPairsAreNamed) {
  std::vector<monitor::MoveLog> logs;
  for (const std::uint32_t number : {1, 2, 3, 2, 1, 2}) logs.push_back(log_of(plain(random_run(number, 20))));
  const std::optional<monitor::EqualLogs> equal = monitor::equal_logs(logs);
  ASSERT_TRUE(equal);
  EXPECT_EQ(equal->logs, (std::vector<std::size_t>{0, 4}));
  EXPECT_EQ(equal->moves, 20);
  EXPECT_TRUE(equal->whole);
  EXPECT_FALSE(equal->few_values);
  EXPECT_FALSE(monitor::equal_logs(std::span(logs).first(3)));
}

}  // namespace
}  // namespace zerocount::testing
