// Tables: what is read, and how each fault is named with its line.
#include "experiments/tables/text_table.hpp"

#include <string>

#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

class TextTables : public ::testing::Test {
 protected:
  tables::TextTable table(const std::string& text) {
    return tables::TextTable(folder_.write("data.csv", text));
  }

  /// The message with which the text is refused when the numbers of its column `x` are read; checks that the
  /// failure has this exit code.
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

TEST_F(TextTables, NumbersReadBackToTheSameDouble) {
  const tables::TextTable read = table("x,y\n0.1,1\n-2.4e-4,+2\n 5e-324 ,3\n1.7976931348623157e308,4\n");
  EXPECT_EQ(read.numbers("x"), (std::vector<double>{0.1, -2.4e-4, 5e-324, 1.7976931348623157e308}));
  EXPECT_EQ(read.numbers("y"), (std::vector<double>{1, 2, 3, 4}));
}

TEST_F(TextTables, ReadsByteOrderMarksQuotesCommentsAndBlankLines) {
  // Byte order mark, carriage returns, quotation marks, comments, empty lines, units, no last line feed.
  const tables::TextTable read =
      table("\xEF\xBB\xBF# a machine\r\n\"t [s]\", torque [N m] \r\n\r\n\"0.5\" , 1\r\n# more\r\n1.5,2");
  EXPECT_EQ(read.unit("t"), "s");
  EXPECT_EQ(read.unit("torque"), "N m");
  EXPECT_EQ(read.numbers("t"), (std::vector<double>{0.5, 1.5}));
  EXPECT_EQ(read.numbers("torque"), (std::vector<double>{1, 2}));
  EXPECT_EQ(read.line(0), 4u);
  EXPECT_EQ(read.line(1), 6u);
}

TEST_F(TextTables, AColumnOfWordsIsComparedWithAWord) {
  const tables::TextTable read = table("x,mode\n1,stick\n2,slide\n");
  EXPECT_EQ(read.equals("mode", "slide"), (std::vector<bool>{false, true}));
}

TEST_F(TextTables, CellsThatAreNotNumbersAreNamedWithTheirLines) {
  EXPECT_EQ(refusal("x,y\n1,0\nabc,0\n", ExitCode::bad_data), ":3: x: 'abc' is not a finite number");
  EXPECT_EQ(refusal("y,x\n1,\n", ExitCode::bad_data), ":2: x: an empty cell is not a finite number");
  for (const std::string cell : {"nan", "inf", "-inf", "1e999", "1.5.2", "0x10", "1 2", "--1"}) {
    EXPECT_EQ(refusal("x,y\n1,0\n\n" + cell + ",0\n", ExitCode::bad_data),
              ":4: x: '" + cell + "' is not a finite number");
  }
}

TEST_F(TextTables, ListsTheFirstFaultsAndCountsTheRest) {
  std::string text = "x,y\n";
  for (int i = 0; i < 8; ++i) text += "?,0\n";
  const std::string message = refusal(text, ExitCode::bad_data);
  EXPECT_NE(message.find(":6: x: '?'"), std::string::npos) << message;
  EXPECT_EQ(message.find(":7: x: '?'"), std::string::npos) << message;
  EXPECT_NE(message.find("and 3 more"), std::string::npos) << message;
}

TEST_F(TextTables, EverySeparatorIsDetected) {
  const std::vector<double> x{0.001, 0.002};
  for (const std::string text :
       {"x,y [N m]\n0.001,1\n0.002,2\n", "x;y [N m]\n0.001;1\n0.002;2\n", "x\ty [N m]\n0.001\t1\n0.002\t2\n",
        "x y [N m]\n0.001 1\n  0.002   2 \n", "x;y [N m]\n0,001;1\n0,002;2\n",
        "x y [N m]\n0,001 1\n0,002 2\n", "x\ty [N m]\n1,0e-3\t1\n0,002\t2\n"}) {
    const tables::TextTable read = table(text);
    EXPECT_EQ(read.numbers("x"), x) << text;
    EXPECT_EQ(read.numbers("y"), (std::vector<double>{1, 2})) << text;
    EXPECT_EQ(read.unit("y"), "N m") << text;
  }
}

// Blanks between decimal commas, where the rows have as many commas as the header.
TEST_F(TextTables, DecimalCommasAreNotTakenForSeparators) {
  const tables::TextTable read = table("0,001 0,5 12\n0,002 -0,6 13\n");
  EXPECT_EQ(read.numbers("#2"), (std::vector<double>{0.5, -0.6}));
  EXPECT_EQ(read.numbers("#3"), (std::vector<double>{12, 13}));
}

TEST_F(TextTables, AGivenSeparatorIsTaken) {
  const tables::TextTable read(folder_.write("data.csv", "x;y\n1,5;2\n"), tables::Separator::semicolon);
  EXPECT_EQ(read.numbers("x"), (std::vector<double>{1.5}));
  EXPECT_THROW(tables::TextTable(folder_ / "data.csv", tables::Separator::tab), Failure);
}

TEST_F(TextTables, MixedDecimalMarksAreRefused) {
  EXPECT_EQ(refusal("x;y\n1,5;2\n2.5;3\n", ExitCode::bad_data),
            ":3: x: a decimal point; line 2 has a decimal comma: expected one kind");
  EXPECT_EQ(refusal("x;y\n1.234,5;2\n", ExitCode::bad_data), ":2: x: '1.234,5' is not a finite number");
}

TEST_F(TextTables, ALineOfUnitsBelowTheHeaderIsRead) {
  for (const std::string text : {"x;y;z\ns;mN m;-\n1;2;3\n", "% a machine\nx;y;z\n[s];[mN·m];\n1;2;3\n",
                                 "x;y [mN m];z\n(s);(kN);\n1;2;3\n"}) {
    const tables::TextTable read = table(text);
    EXPECT_EQ(read.unit("x"), "s") << text;
    EXPECT_TRUE(read.unit("y") == "mN m" || read.unit("y") == "mN·m") << text;
    EXPECT_EQ(read.unit("z"), "") << text;
    EXPECT_EQ(read.numbers("z"), (std::vector<double>{3})) << text;
  }
  // A unit beside a known one may be unknown: who uses its column is told so.
  const tables::TextTable unknown = table("x;y\nabc;s\n1;2\n");
  EXPECT_EQ(unknown.unit("x"), "abc");
  EXPECT_EQ(unknown.numbers("x"), (std::vector<double>{1}));
  // A row that is not of units is a row of data.
  EXPECT_EQ(refusal("x;y\nabc;def\n1;2\n", ExitCode::bad_data), ":2: x: 'abc' is not a finite number");
}

TEST_F(TextTables, UnitsInRoundBracketsAreRead) {
  const tables::TextTable read = table("Time (ms),torque (filtered),phi (°)\n1,2,3\n");
  EXPECT_EQ(read.unit("Time"), "ms");
  EXPECT_EQ(read.unit("phi"), "°");
  EXPECT_EQ(read.numbers("torque (filtered)"), (std::vector<double>{2}));
  EXPECT_EQ(read.unit("torque (filtered)"), "");
  // What is no known unit may be an unknown one, unless two columns have the name before it.
  EXPECT_EQ(read.numbers("torque"), (std::vector<double>{2}));
  EXPECT_EQ(read.unit("torque"), "filtered");
  EXPECT_FALSE(table("pos (act),pos (ref)\n1,2\n").has("pos"));
}

// What numpy.savetxt(header=…) writes, and what has no header at all.
TEST_F(TextTables, WithoutAHeaderTheCommentAboveOrNumbersNameTheColumns) {
  EXPECT_EQ(table("# a machine\n# x y [A]\n1 2\n3 4\n").numbers("y"), (std::vector<double>{2, 4}));
  const tables::TextTable read = table("# of 3 November\n1 2\n3 4\n");
  EXPECT_EQ(read.numbers("#1"), (std::vector<double>{1, 3}));
  EXPECT_EQ(read.line(0), 2u);
  EXPECT_FALSE(read.has("#3"));
  EXPECT_FALSE(read.has("#0"));
  EXPECT_FALSE(read.has(""));
}

// Titles of loggers and oscilloscopes, which have another number of cells.
TEST_F(TextTables, TitlesAboveTheHeaderAreSkipped) {
  for (const char* text : {"Scope export\nx,y\n1,2\n3,4\n", "Scope export, axis X, left\n\nx,y\n1,2\n3,4\n",
                           "Device;X\nDate;2026-11-26\nSamples;2\nx;y;z\n1;2;0\n3;4;0\n",
                           "of November\nrate 2000 Hz\nx [mm],y [s]\n1,2\n3,4\n",
                           "Logger 3\nx\ty\nmm\ts\n1\t2\n3\t4\n", "a b c d\nx y\n1 2\n3 4\n"}) {
    const tables::TextTable read = table(text);
    EXPECT_EQ(read.numbers("x"), (std::vector<double>{1, 3})) << text;
    EXPECT_EQ(read.numbers("y"), (std::vector<double>{2, 4})) << text;
  }
  EXPECT_EQ(table("Scope export\nx,y\n1,2\n").line(0), 3u);
}

// A row is never taken for a title or a header.
TEST_F(TextTables, RowsOfAnotherLengthAreErrorsEvenBelowTitles) {
  for (const char* text : {"x,y\n1,2\n3\n", "x,y\n1\n3,4\n5,6\n", "x,y\n1,2,3\n3,4,5\n",
                           "Scope\nx,y\n1,2\n3\n", "Scope\nx,y\n1\n3,4\n5,6\n"})
    EXPECT_THROW(table(text), Failure) << text;
}

TEST_F(TextTables, RowsMayEndWithASeparatorThatTheHeaderLacks) {
  EXPECT_EQ(table("x;y\n1,5;2;\n3;4;\n").numbers("y"), (std::vector<double>{2, 4}));
  EXPECT_EQ(table("x,y,\n1,2,\n3,4,\n").numbers("y"), (std::vector<double>{2, 4}));
}

TEST_F(TextTables, TheUnitOfCountsMayBeWrittenAsOne) {
  const tables::TextTable read = table("x,count\nmm,1\n1,2\n");
  EXPECT_EQ(read.rows(), 1u);
  EXPECT_EQ(read.unit("count"), "1");
}

TEST_F(TextTables, LinesMayEndWithOnlyACarriageReturn) {
  EXPECT_EQ(table("x,y\r1,2\r3,4\r").numbers("y"), (std::vector<double>{2, 4}));
}

TEST_F(TextTables, TimeStampsAreRefusedWithAHint) {
  try {
    table("t,x\n2026-11-26T12:00:00.5,1\n2026-11-26T12:00:00.6,1\n").numbers("t");
    ADD_FAILURE();
  } catch (const Failure& failure) {
    EXPECT_NE(std::string(failure.what()).find("but a time stamp; expected seconds"), std::string::npos)
        << failure.what();
  }
}

TEST_F(TextTables, FilesThatAreNotTablesAreRefused) {
  EXPECT_EQ(refusal("x,y\n1,2\n3\n", ExitCode::bad_data),
            ":3: a row of 1 cells; expected 2, as the header has");
  EXPECT_EQ(refusal("zerocount\n", ExitCode::bad_input),
            ":1: one cell only; expected columns separated by commas, semicolons, tabs or blanks");
  EXPECT_EQ(refusal("x,x\n1,2\n", ExitCode::bad_input), ":1: two columns are named 'x'; expected each once");
  EXPECT_EQ(refusal("", ExitCode::bad_input), ":1: the table is empty; expected a table");
  EXPECT_EQ(refusal(std::string("a\0b\n", 4), ExitCode::bad_input),
            ":1: the table is not text; expected a table of numbers, or a results file");
  EXPECT_THROW(tables::TextTable(folder_ / "nothing.csv"), Failure);
  EXPECT_THROW(tables::TextTable(folder_.path()), Failure);
}

}  // namespace
}  // namespace zerocount::testing
