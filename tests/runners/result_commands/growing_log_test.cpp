// A log that another process writes, replaces, moves or cuts.
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "runners/result_commands/machine_logs.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

using result_commands::GrowingLog;

std::string rows(int moves, int value) {
  std::string text;
  for (int i = 0; i < moves; ++i) text += fmt::format("{}.{},{}\n", value, i % 10, i % 3);
  return text;
}

const std::string head = "settling_time [ms],overshoot\n";

class GrowingLogTest : public ::testing::TestWithParam<bool> {
 protected:
  /// Writes the log in place, or as another file that takes its place.
  void write(const std::string& text) {
    folder_.write(GetParam() ? "moves.csv" : "new.csv", text);
    if (!GetParam()) std::filesystem::rename(folder_.path() / "new.csv", folder_.path() / "moves.csv");
  }
  /// The message, with the exit code, of the reading after this text took the place of the log.
  std::string refusal(const std::string& text) {
    write(head + rows(30, 40));
    GrowingLog log(folder_.path() / "moves.csv");
    EXPECT_TRUE(log.read());
    EXPECT_FALSE(log.read());
    write(text);
    try {
      log.read();
    } catch (const Failure& failure) {
      return fmt::format("{}{}", static_cast<int>(failure.code()),
                         std::string(failure.what()).substr((folder_.path() / "moves.csv").string().size()));
    }
    return fmt::format("{} moves", log.log().moves);
  }

  TemporaryFolder folder_;
};

TEST_P(GrowingLogTest, RefusesAnotherLog) {
  EXPECT_EQ(refusal(head + rows(5, 41) + rows(60, 40)),
            "4: another log took its place after 30 moves; expected a file that only grows");
  EXPECT_EQ(refusal("overshoot,settling_time [ms]\n" + rows(60, 1)),
            "4:1: the line became 'overshoot,settling_time [ms]' while the log was followed; expected "
            "'settling_time [ms],overshoot', as it was");
  EXPECT_EQ(refusal("settling_time [s],overshoot\n" + rows(60, 40)),
            "4:1: the line became 'settling_time [s],overshoot' while the log was followed; expected "
            "'settling_time [ms],overshoot', as it was");
  EXPECT_EQ(refusal(head + rows(5, 40)),
            "4: became shorter while it was followed; expected a file that only grows");
  EXPECT_EQ(refusal(""), "4: became shorter while it was followed; expected a file that only grows");
  // Far from the beginning: only the last rows that were read differ.
  EXPECT_EQ(refusal(head + rows(29, 40) + rows(60, 50)),
            "4: another log took its place after 30 moves; expected a file that only grows");
}

// As rsync copies a log that grows: each copy is another file.
TEST_P(GrowingLogTest, ReadsOnWhereTheFileBeginsWithWhatWasRead) {
  EXPECT_EQ(refusal(head + rows(30, 40) + rows(7, 45)), "37 moves");
  EXPECT_EQ(refusal(head + rows(30, 40)), "30 moves");
  // A longer log than what is compared, and a last line that was not complete.
  write(head + rows(5000, 40) + "40.");
  GrowingLog log(folder_.path() / "moves.csv");
  EXPECT_TRUE(log.read());
  write(head + rows(5000, 40) + "41.5,2\n" + rows(3, 40));
  EXPECT_TRUE(log.read());
  EXPECT_EQ(log.log().moves, 5004);
  write(head + rows(4999, 40) + "39.9,1\n41.5,2\n" + rows(9, 40));
  EXPECT_THROW(log.read(), Failure);
}

INSTANTIATE_TEST_SUITE_P(InPlaceAndMoved, GrowingLogTest, ::testing::Bool());

}  // namespace
}  // namespace zerocount::testing
