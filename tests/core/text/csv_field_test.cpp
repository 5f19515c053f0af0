#include "core/text/csv_field.hpp"

#include <gtest/gtest.h>

namespace zerocount::testing {
namespace {

TEST(CsvField, IsQuotedWhereItMustBe) {
  EXPECT_EQ(text::csv_field("plain text"), "plain text");
  EXPECT_EQ(text::csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(text::csv_field("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(text::csv_field("two\nlines"), "\"two\nlines\"");
}

TEST(CsvField, IsNoCommandOfASpreadsheet) {
  EXPECT_EQ(text::csv_field("=cmd|' /C calc'!A0"), "'=cmd|' /C calc'!A0");
  EXPECT_EQ(text::csv_field("@SUM(1,2)"), "\"'@SUM(1,2)\"");
  EXPECT_EQ(text::csv_field("-2+3+cmd|' /C calc'!A0"), "'-2+3+cmd|' /C calc'!A0");
  EXPECT_EQ(text::csv_field("+1+1"), "'+1+1");  // no 2
  EXPECT_EQ(text::csv_field("-slow"), "'-slow");
  EXPECT_EQ(text::csv_field("- 3"), "'- 3");
  EXPECT_EQ(text::csv_field("+15 %"), "+15 %");
  EXPECT_EQ(text::csv_field("-1.5e-3"), "-1.5e-3");
  EXPECT_EQ(text::csv_field("-inf"), "-inf");
}

}  // namespace
}  // namespace zerocount::testing
