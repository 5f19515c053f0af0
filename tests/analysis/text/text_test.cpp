#include "analysis/text/text.hpp"

#include "tests/support/test.hpp"

namespace zerocount::text {
namespace {

TEST(Text, OnlyNoneIsZeroPercentAndOnlyAllIsAHundred) {
  EXPECT_EQ(percentage(0, 1000000), "0 %");
  EXPECT_EQ(percentage(1, 1000000), "< 0.1 %");
  EXPECT_EQ(percentage(1, 1000), "0.1 %");
  EXPECT_EQ(percentage(1, 3), "33.3 %");
  EXPECT_EQ(percentage(999, 1000), "99.9 %");
  EXPECT_EQ(percentage(999999, 1000000), "> 99.9 %");
  EXPECT_EQ(percentage(7, 7), "100 %");
  EXPECT_EQ(percentage(0, 0), "–");
}

TEST(Text, NumbersAreShortAndMissingOnesADash) {
  EXPECT_EQ(short_number(0.1125), "0.1125");
  EXPECT_EQ(short_number(3.0), "3");
  EXPECT_EQ(short_number(std::nan("")), "–");
}

TEST(Text, WidthIsThatOfTheTerminal) {
  EXPECT_EQ(display_width("abc"), 3U);
  EXPECT_EQ(display_width("β = 2·10⁵"), 9U);
  EXPECT_EQ(display_width("e\u0301"), 1U);  // e with a combining accent
  EXPECT_EQ(display_width("位置"), 4U);
  EXPECT_EQ(display_width("\xFFz"), 2U);  // a byte that is not UTF-8, shown as U+FFFD
}

TEST(Text, PrintableTextStaysOnOneLine) {
  EXPECT_EQ(printable("k₁ = 110"), "k₁ = 110");
  EXPECT_EQ(printable("a\nb\x1B[31mc"), "a\uFFFDb\uFFFD[31mc");
  EXPECT_EQ(printable("a\u202Eb\u2066c"), "a\uFFFDb\uFFFDc");  // change the direction of what follows
  EXPECT_EQ(printable("\xC3"), "\uFFFD");                      // cut off
  EXPECT_EQ(printable("\xC0\xAF"), "\uFFFD\uFFFD");            // overlong
  EXPECT_EQ(printable("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD");  // a surrogate
  EXPECT_EQ(printable("\xE0\x80\xAF"), "\uFFFD\uFFFD\uFFFD");  // overlong in three bytes
  EXPECT_EQ(printable("\xF0\x9F\x98\x80"), "\xF0\x9F\x98\x80");
}

TEST(Text, ColumnsOfATableAlignWhateverTheScript) {
  EXPECT_EQ(aligned_table({{"name", false, {"位置", "β"}}, {"n", true, {"7", "12"}}}),
            "name   n\n"
            "────  ──\n"
            "位置   7\n"
            "β     12\n");
}

}  // namespace
}  // namespace zerocount::text
