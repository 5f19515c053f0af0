// A message can be shown whatever text of a file or of the user it repeats.
#include "core/text/utf8.hpp"

#include <gtest/gtest.h>

namespace zerocount::testing {
namespace {

TEST(Utf8, TextOfAnyScriptStaysAsItIs) {
  for (const std::string text : {"", "k1 = 110 N m/rad", "Δx ≥ 1 µm", "日本語 🙂", "two\nlines"}) {
    EXPECT_EQ(text::printable_lines(text), text);
    EXPECT_EQ(text::is_printable(text), text.find('\n') == std::string::npos) << text;
  }
}

TEST(Utf8, ControlCharactersAreReplaced) {
  EXPECT_EQ(text::printable_lines("a\x1b[31m\tb\x7f"), "a\uFFFD[31m\tb\uFFFD");
  EXPECT_EQ(text::printable_lines("\xC2\x9B"
                                  "31m"),
            "\uFFFD31m");                                      // the control sequence introducer in C1
  EXPECT_EQ(text::printable_lines("\xE2\x80\xA8"), "\uFFFD");  // line separator
  EXPECT_EQ(text::printable_lines("a\u202Eb\u2066c"), "a\uFFFDb\uFFFDc");  // change the direction of text
}

// Overlong forms, surrogates, values beyond U+10FFFF, and sequences that are cut short (RFC 3629).
TEST(Utf8, BytesThatAreNotUtf8AreReplacedOneByOne) {
  for (const std::string text : {"\xFF", "\x80", "\xC3"}) EXPECT_EQ(text::printable_lines(text), "\uFFFD");
  for (const std::string text : {"\xC0\xAF", "\xE2\x82"})
    EXPECT_EQ(text::printable_lines(text), "\uFFFD\uFFFD");
  for (const std::string text : {"\xED\xA0\x80", "\xE0\x80\x80"})
    EXPECT_EQ(text::printable_lines(text), "\uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(text::printable_lines("\xF5\x80\x80\x80"), "\uFFFD\uFFFD\uFFFD\uFFFD");
  EXPECT_FALSE(text::is_printable("a\xFF"));
}

}  // namespace
}  // namespace zerocount::testing
