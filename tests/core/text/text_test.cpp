#include "core/text/text.hpp"

#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

TEST(Counted, OneIsSingular) {
  EXPECT_EQ(text::counted(std::int64_t{1}, "move"), "1 move");
  EXPECT_EQ(text::counted(std::size_t{0}, "move"), "0 moves");
  EXPECT_EQ(text::counted(11, "design point"), "11 design points");
}

TEST(CsvField, IsQuotedWhereItMustBe) {
  EXPECT_EQ(text::csv_field("plain text"), "plain text");
  EXPECT_EQ(text::csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(text::csv_field("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(text::csv_field("two\nlines"), "\"two\nlines\"");
}

TEST(CsvField, IsNeverASpreadsheetFormula) {
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

namespace zerocount {
namespace {

TEST(NumberText, MustBeANumberAsAWhole) {
  EXPECT_EQ(text::parse_number<double>("3.16e-5"), 3.16e-5);
  EXPECT_EQ(text::parse_number<std::int64_t>("-7"), -7);
  for (const char* const other : {"", "3,16", "3.1 ", " 3", "+3", "3e", "x", "1e999"})
    EXPECT_FALSE(text::parse_number<double>(other)) << other;
  EXPECT_FALSE(text::parse_number<std::int64_t>("7.0"));
}

TEST(NumberText, RoundsToTheDoubleNearestToTheDecimalNumber) {
  EXPECT_EQ(text::round_to_digits(1.9999999999999998e-05, 15), 2e-05);
  EXPECT_EQ(text::round_to_digits(-1234567.0, 2), -1200000.0);
  EXPECT_EQ(text::round_to_digits(0.0, 3), 0.0);
  EXPECT_TRUE(std::isnan(text::round_to_digits(std::nan(""), 3)));
  EXPECT_TRUE(std::isinf(text::round_to_digits(std::numeric_limits<double>::infinity(), 3)));
  std::mt19937_64 random(59);
  std::uniform_real_distribution<double> exponent(-300.0, 300.0);
  for (int i = 0; i < 1000; ++i) {
    const double value = std::pow(10.0, exponent(random));
    for (const int digits : {1, 5, 15}) {
      const double rounded = text::round_to_digits(value, digits);
      EXPECT_LE(std::abs(rounded - value), 0.51 * std::pow(10.0, 1 - digits) * value);
      EXPECT_EQ(rounded, std::stod(fmt::format("{:.{}g}", value, digits)));
    }
  }
}

}  // namespace
}  // namespace zerocount

// Words of commands that are written for people and for scripts, read by the shell itself.

namespace zerocount::text {
namespace {

std::string random_word(std::mt19937& random) {
  constexpr std::string_view characters = "ab-=,'\"\\ $`*?;&|<>()[]{}#!~%@\t\n\r\xc3\xa9";
  std::string word;
  for (std::size_t i = random() % 12; i > 0; --i) word += characters[random() % characters.size()];
  return word;
}

/// Output of a command that is run by `sh`.
std::string printed_by(const std::string& command) {
  std::string text;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "cannot be started";
  std::array<char, 4096> part{};
  for (std::size_t read = 0; (read = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), read);
  EXPECT_EQ(pclose(pipe), 0) << command;
  return text;
}

TEST(ShellWord, IsReadAsOneWordByEveryShell) {
  std::mt19937 random(5);
  for (int repetition = 0; repetition < 20; ++repetition) {
    std::string script, words;
    for (int i = 0; i < 100; ++i) {
      const std::string word = random_word(random);
      script += fmt::format("printf '%s\\0' {}\n", shell_word(word));
      words += word + '\0';
    }
    EXPECT_TRUE(printed_by(script) == words) << script;
    EXPECT_TRUE(printed_by("bash -c " + shell_word(script)) == words) << script;
  }
}

TEST(ShellWord, IsUnchangedIfItNeedsNoQuotes) {
  EXPECT_EQ(shell_word("studies/axis-1.yaml"), "studies/axis-1.yaml");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(ShellPath, IsNeverTakenForAnOption) {
  EXPECT_EQ(shell_path("-o.yaml"), "./-o.yaml");
  EXPECT_EQ(shell_path("-"), "-");
  EXPECT_EQ(shell_path("a b/-o.yaml"), "'a b/-o.yaml'");
}

TEST(Trimmed, LosesBlanksAtBothEndsOnly) {
  EXPECT_EQ(trimmed(" \t a b\r\n"), "a b");
  EXPECT_EQ(trimmed(" \n "), "");
  EXPECT_EQ(trimmed(" \"a\" ", " \""), "a");
}

}  // namespace
}  // namespace zerocount::text

// A message can be shown whatever text of a file or of the user it repeats.

namespace zerocount::testing {
namespace {

TEST(Utf8, TextOfAnyScriptIsUnchanged) {
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
TEST(Utf8, InvalidBytesAreReplacedOneByOne) {
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
