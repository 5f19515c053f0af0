// Tables: what is read, and how each fault is named with its line.
#include "analysis/identification/csv_table.hpp"

#include <string>

#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

class CsvTables : public ::testing::Test {
 protected:
  identification::CsvTable table(const std::string& text) {
    return identification::CsvTable(folder_.write("data.csv", text));
  }

  /// The message with which the text is refused, the column `x` read as numbers.
  std::string refusal(const std::string& text, ExitCode code) {
    try {
      table(text).numbers("x");
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), code) << failure.what();
      const std::string message = failure.what();
      const std::string name = (folder_ / "data.csv").string();
      EXPECT_EQ(message.find(name), 0u) << message;
      return message.substr(name.size());
    }
    ADD_FAILURE() << "not refused: " << text;
    return "";
  }

  TemporaryFolder folder_;
};

TEST_F(CsvTables, NumbersReadBackToTheSameDouble) {
  const identification::CsvTable read =
      table("x,y\n0.1,1\n-2.4e-4,+2\n 5e-324 ,3\n1.7976931348623157e308,4\n");
  EXPECT_EQ(read.numbers("x"), (std::vector<double>{0.1, -2.4e-4, 5e-324, 1.7976931348623157e308}));
  EXPECT_EQ(read.numbers("y"), (std::vector<double>{1, 2, 3, 4}));
}

TEST_F(CsvTables, TakesWhatOtherProgramsWrite) {
  // Byte order mark, carriage returns, quotation marks, comments, empty lines, units, no last line feed.
  const identification::CsvTable read =
      table("\xEF\xBB\xBF# a rig\r\n\"t [s]\", torque [N m] \r\n\r\n\"0.5\" , 1\r\n# more\r\n1.5,2");
  EXPECT_EQ(read.unit("t"), "s");
  EXPECT_EQ(read.unit("torque"), "N m");
  EXPECT_EQ(read.numbers("t"), (std::vector<double>{0.5, 1.5}));
  EXPECT_EQ(read.numbers("torque"), (std::vector<double>{1, 2}));
  EXPECT_EQ(read.line(0), 4u);
  EXPECT_EQ(read.line(1), 6u);
}

TEST_F(CsvTables, WordsAreCompared) {
  const identification::CsvTable read = table("x,mode\n1,stick\n2,slide\n");
  EXPECT_EQ(read.equals("mode", "slide"), (std::vector<bool>{false, true}));
}

TEST_F(CsvTables, CellsThatAreNoNumbersAreNamedWithTheirLines) {
  EXPECT_EQ(refusal("x,y\n1,0\nabc,0\n", ExitCode::bad_data), ":3: x: 'abc' is no finite number");
  EXPECT_EQ(refusal("y,x\n1,\n", ExitCode::bad_data), ":2: x: an empty cell is no finite number");
  for (const std::string cell : {"nan", "inf", "-inf", "1e999", "1.5.2", "0x10", "1 2", "--1"}) {
    EXPECT_EQ(refusal("x,y\n1,0\n\n" + cell + ",0\n", ExitCode::bad_data),
              ":4: x: '" + cell + "' is no finite number");
  }
}

TEST_F(CsvTables, ListsTheFirstFaultsAndCountsTheRest) {
  std::string text = "x,y\n";
  for (int i = 0; i < 8; ++i) text += "?,0\n";
  const std::string message = refusal(text, ExitCode::bad_data);
  EXPECT_NE(message.find(":6: x: '?'"), std::string::npos) << message;
  EXPECT_EQ(message.find(":7: x: '?'"), std::string::npos) << message;
  EXPECT_NE(message.find("and 3 more"), std::string::npos) << message;
}

TEST_F(CsvTables, WhatIsNoTableIsRefused) {
  EXPECT_EQ(refusal("x,y\n1,2\n3\n", ExitCode::bad_data),
            ":3: a row of 1 cells; expected 2, as the header has");
  EXPECT_EQ(refusal("x;y\n1;2\n", ExitCode::bad_input),
            ": the header has no comma; expected columns separated by commas, not by semicolons");
  EXPECT_EQ(refusal("zerocount: 1\n", ExitCode::bad_input),
            ": the header has no comma; expected columns separated by commas");
  EXPECT_EQ(refusal("x,x\n1,2\n", ExitCode::bad_input), ": two columns are named 'x'");
  EXPECT_EQ(refusal("", ExitCode::bad_input), ": is empty; expected a table");
  EXPECT_EQ(refusal(std::string("a\0b\n", 4), ExitCode::bad_input),
            ": is no text; expected comma-separated values, or a results file");
  EXPECT_THROW(identification::CsvTable(folder_ / "nothing.csv"), Failure);
  EXPECT_THROW(identification::CsvTable(folder_.path()), Failure);
}

}  // namespace
}  // namespace zerocount::testing
