#include "analysis/basis/text/text.hpp"

#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::text {
namespace {

TEST(Text, OnlyExactFractionsAreZeroOrAHundredPercent) {
  EXPECT_EQ(percentage(0, 1000000), "0 %");
  EXPECT_EQ(percentage(1, 1000000), "< 0.1 %");
  EXPECT_EQ(percentage(1, 1000), "0.1 %");
  EXPECT_EQ(percentage(1, 3), "33.3 %");
  EXPECT_EQ(percentage(999, 1000), "99.9 %");
  EXPECT_EQ(percentage(999999, 1000000), "> 99.9 %");
  EXPECT_EQ(percentage(7, 7), "100 %");
  EXPECT_EQ(percentage(0, 0), "–");
}

TEST(Text, NumbersAreShortAndMissingOnesAreADash) {
  EXPECT_EQ(short_number(0.1125), "0.1125");
  EXPECT_EQ(short_number(3.0), "3");
  EXPECT_EQ(short_number(std::nan("")), "–");
}

TEST(Text, DisplayWidthCountsTerminalCells) {
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

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::size_t width_of(const std::string& text) {
  std::size_t width = 0;
  for (const std::string& line : lines_of(text)) width = std::max(width, display_width(line));
  return width;
}

/// The words of a text without the lines that underline heads, sorted.
std::vector<std::string> split_words(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) {
    if (word.rfind("─", 0) != 0) words.push_back(word);
  }
  std::sort(words.begin(), words.end());
  return words;
}

/// A random table of words, all of which are different.
std::vector<TextColumn> random_table(std::mt19937_64& random, std::size_t rows) {
  std::uniform_int_distribution<std::size_t> length(1, 9), words(1, 6), columns(1, 12);
  std::size_t number = 0;
  const auto word = [&] {
    return std::string(length(random), random() % 2 == 0 ? 'x' : 'e') + std::to_string(number++);
  };
  std::vector<TextColumn> table;
  for (std::size_t column = columns(random); column > 0; --column) {
    TextColumn& added = table.emplace_back(TextColumn{word(), random() % 2 == 0, {}});
    for (std::size_t row = 0; row < rows; ++row) {
      std::string& cell = added.cells.emplace_back(word());
      for (std::size_t more = words(random); more > 1 && !added.numeric; --more) cell += " " + word();
    }
  }
  return table;
}

TEST(AlignedTable, HasTheWidthAndEveryWordOfATable) {
  std::mt19937_64 random(2002);
  for (int round = 0; round < 500; ++round) {
    const std::vector<TextColumn> columns = random_table(random, 1 + random() % 5);
    const std::string table = aligned_table(columns);
    const std::size_t width = 45 + random() % 100;
    const std::string shown = aligned_table(columns, width);
    EXPECT_LE(width_of(shown), width);
    if (width_of(table) <= width) {
      EXPECT_EQ(shown, table);
    }
    // The first column stands in every part.
    std::vector<std::string> words = split_words(shown), expected = split_words(table);
    words.erase(std::unique(words.begin(), words.end()), words.end());
    EXPECT_EQ(words, expected);
  }
}

// A long sentence in a cell makes no long lines where the width has no limit, and keeps its words whole.
TEST(AlignedTable, WrapsLongCellsEvenIfTheWidthIsUnlimited) {
  std::mt19937_64 random(2209);
  for (int round = 0; round < 100; ++round) {
    std::vector<TextColumn> columns{{"name", false, {}}, {"n", true, {}}, {"meaning", false, {}}};
    std::vector<std::string> words;
    for (int row = 0; row < 4; ++row) {
      std::string sentence;
      for (std::size_t word = random() % 200; word > 0; --word) {
        words.push_back(std::string(1 + random() % 12, static_cast<char>('a' + random() % 26)));
        sentence += (sentence.empty() ? "" : " ") + words.back();
      }
      columns[0].cells.push_back("row" + std::to_string(row));
      columns[1].cells.emplace_back("7");
      columns[2].cells.push_back(sentence);
    }
    const std::string table = aligned_table(columns);
    EXPECT_LE(width_of(table), 4U + 2U + 1U + 2U + width_of_prose);
    for (const std::string& word : words) EXPECT_NE(table.find(word), std::string::npos) << word;
  }
  const std::string path(150, 'p');
  EXPECT_NE(aligned_table({{"name", false, {"a"}}, {"file", false, {path + " " + path}}}).find(path),
            std::string::npos);
}

TEST(AlignedTable, RepeatsTheNamesOfTheRows) {
  const std::vector<TextColumn> columns{{"point", true, {"0", "1"}},
                                        {"zero-count", true, {"98.0 %", "7 %"}},
                                        {"bounds", true, {"[97, 99]", "[6, 8]"}},
                                        {"observed", false, {"stable in all tests", "unstable"}}};
  EXPECT_EQ(aligned_table(columns, 32),
            "point  zero-count    bounds\n"
            "─────  ──────────  ────────\n"
            "    0      98.0 %  [97, 99]\n"
            "    1         7 %    [6, 8]\n"
            "\n"
            "point  observed\n"
            "─────  ───────────────────\n"
            "    0  stable in all tests\n"
            "    1  unstable\n");
}

TEST(FittedText, WrapsSentencesBetweenWords) {
  EXPECT_EQ(fitted("  (6) holds: proportion of the trials\nend\n", 24),
            "  (6) holds: proportion\n"
            "    of the trials\n"
            "end\n");
  EXPECT_EQ(width_of(fitted(std::string(200, 'a') + " b", 100)), 200U);  // no word is broken
  EXPECT_EQ(fitted("of 97.5 % of moves", 10), "of 97.5 %\n  of moves");
  std::string sentence;
  for (int i = 0; i < 60; ++i) sentence += "word ";
  EXPECT_LE(width_of(fitted(sentence, 300)), width_of_prose);
  EXPECT_EQ(fitted(sentence, std::nullopt), sentence);
  EXPECT_EQ(split_words(fitted(sentence, 40)), split_words(sentence));
}

TEST(FittedText, AnEntryContinuesBelowItsText) {
  EXPECT_EQ(fitted("  --threads N   threads to use, all by default\n", 36),
            "  --threads N   threads to use, all\n"
            "                by default\n");
  // Where too little room would be left, the line continues as others do.
  EXPECT_EQ(fitted("  a rather long name  of a few words\n", 24),
            "  a rather long name  of\n"
            "    a few words\n");
}

TEST(ShortenedText, LeavesOutTheMiddleFirst) {
  const std::string line = "7 of 9 trials, 3 from before, 80 trials/s, 2 s to go";
  EXPECT_EQ(shortened(line, 80), line);
  EXPECT_EQ(shortened(line, 45), "7 of 9 trials, 3 from before, 2 s to go");
  EXPECT_EQ(shortened(line, 30), "7 of 9 trials, 2 s to go");
  EXPECT_EQ(shortened(line, 20), "7 of 9 trials");
  EXPECT_EQ(shortened(line, 8), "7 of 9 …");
  for (std::size_t width = 2; width < 60; ++width) EXPECT_LE(width_of(shortened(line, width)), width);
}

TEST(UnwrappedText, JoinsTheLinesOfAParagraph) {
  const std::string by_hand =
      "A paragraph that was\n"
      "wrapped by hand.\n"
      "one: an entry\n"
      "two: another\n"
      "\n"
      "  - an item that is as\n"
      "  - long as the width\n"
      "    or longer\n";
  EXPECT_EQ(unwrapped(by_hand, 22),
            "A paragraph that was wrapped by hand.\n"
            "one: an entry\n"
            "two: another\n"
            "\n"
            "  - an item that is as\n"
            "  - long as the width\n"
            "    or longer\n");
  EXPECT_EQ(split_words(unwrapped(by_hand, 10)), split_words(by_hand));
}

TEST(FittedText, KeepsALineWithoutABreakAtItsEnd) {
  EXPECT_EQ(fitted("short", 80), "short");
  EXPECT_EQ(fitted("", 80), "");
  EXPECT_EQ(fitted("\n\n", 80), "\n\n");
}

TEST(Percent, BoundsAreRoundedToTheSafeSide) {
  std::mt19937_64 random(96);
  std::uniform_real_distribution<double> exponent(-6.0, 0.0);
  for (int round = 0; round < 2000; ++round) {
    const double missing = std::pow(10.0, exponent(random));
    const double proportion = 1.0 - missing;
    EXPECT_LE(std::stod(percent_at_least(proportion)), 100.0 * proportion + 1e-9);
    EXPECT_GE(std::stod(percent_at_least(proportion)),
              100.0 * proportion - 100.0 * std::max(0.1 * missing, 1e-3));
    EXPECT_GE(std::stod(percent_at_most(missing)), 100.0 * missing - 1e-9);
    EXPECT_LE(std::stod(percent_at_most(missing)), 100.0 * std::max(1.1 * missing, missing + 1e-3));
    EXPECT_LE(std::stod(rounded_down(proportion, 2)), proportion + 1e-9);
    EXPECT_GE(std::stod(rounded_up(proportion, 2)), proportion - 1e-9);
  }
  EXPECT_EQ(percent_at_least(0.999), "99.9 %");
  EXPECT_EQ(percent_at_least(0.99899), "99.89 %");
  EXPECT_EQ(percent_at_least(0.859383), "85.9 %");
  EXPECT_EQ(percent_at_most(0.00299), "0.3 %");
}

TEST(Percent, ALowerBoundIsNever100AndAnUpperBoundNever0) {
  for (const double missing : {1e-9, 1e-12, 1e-15, 1e-17}) {
    EXPECT_LT(std::stod(percent_at_least(1.0 - missing)), 100.0) << missing;
    EXPECT_GT(std::stod(percent_at_most(missing)), 0.0) << missing;
  }
  EXPECT_EQ(percent_at_least(0.0), "0 %");
  EXPECT_EQ(percent_at_most(0.0), "0 %");
  EXPECT_EQ(percent_at_most(1.0), "100 %");
}

TEST(Percent, IntervalsAreRoundedOutward) {
  EXPECT_EQ(percent_bounds(0.99996, 1.0), "99.9, 100.0");
  EXPECT_EQ(percent_bounds(0.0, 0.00001), "0.0, 0.1");
  EXPECT_EQ(percent_bounds(0.29549, 0.37251), "29.5, 37.3");
  EXPECT_EQ(percent_bounds(0.295, 0.372), "29.5, 37.2");
  EXPECT_EQ(percent_bounds(0.29549, 0.37251, 2, " … "), "29.54 … 37.26");
  EXPECT_EQ(rounded_down(-0.0004, 3), "-0.001");
  EXPECT_EQ(rounded_up(-0.0004, 3), "0.000");
}

TEST(Percent, AGivenNumberIsShownInFull) {
  EXPECT_EQ(percent(0.95), "95 %");
  EXPECT_EQ(percent(0.07), "7 %");
  EXPECT_EQ(percent(0.999), "99.9 %");
  EXPECT_EQ(percent(0.99999999), "99.999999 %");
  EXPECT_EQ(percent(0.999999999999), "99.9999999999 %");
  EXPECT_EQ(percent(1.0 / 3.0), "33.3333 %");
  EXPECT_EQ(percent(1e-7), "1e-05 %");
  EXPECT_EQ(percent(1.0), "100 %");
  EXPECT_EQ(percent(0.0), "0 %");
}

TEST(Quantity, ALengthReadsBackAndHasOneToThreeDigitsBeforeThePoint) {
  const std::map<std::string, double> sizes{
      {"pm", 1e-12}, {"nm", 1e-9}, {"µm", 1e-6}, {"mm", 1e-3}, {"m", 1.0}};
  testing::Draws draws(62);
  for (int round = 0; round < 2000; ++round) {
    const double value = (draws.chance(0.5) ? 1.0 : -1.0) * std::pow(10.0, draws.uniform(-11.99, 2.99));
    const std::string text = quantity_text(value, "m", 6);
    const std::size_t space = text.find(' ');
    const double number = std::stod(text.substr(0, space));
    ASSERT_TRUE(sizes.contains(text.substr(space + 1))) << text;
    EXPECT_GE(std::abs(number), 0.9999) << text;
    EXPECT_LE(std::abs(number), 1000.0) << text;
    EXPECT_NEAR(number * sizes.at(text.substr(space + 1)), value, 5e-6 * std::abs(value)) << text;
  }
}

TEST(Quantity, HasTheUsualPrefixesOfItsUnit) {
  EXPECT_EQ(quantity_text(1e-5, "rad"), "10 µrad");
  EXPECT_EQ(quantity_text(16000, "Hz"), "16 kHz");
  EXPECT_EQ(quantity_text(5.9e6, "N/m"), "5.9e6 N/m");
  EXPECT_EQ(quantity_text(1000, "m/s^3"), "1000 m/s³");
  EXPECT_EQ(quantity_text(0.0, "m"), "0 m");
  EXPECT_EQ(quantity_text(0.8, "1"), "0.8");
  EXPECT_EQ(quantity_text(1.0, "count"), "1 count");
  EXPECT_EQ(quantity_text(200.0, "count"), "200 counts");
  EXPECT_EQ(quantity_text(std::numeric_limits<double>::quiet_NaN(), "s"), "– s");
}

TEST(Quantity, SeveralNumbersShareOnePrefix) {
  EXPECT_EQ(range_text(2e-6, 1.2e-3, "m"), "0.002 … 1.2 mm");
  EXPECT_EQ(range_text(310, 930, "N s/m"), "310 … 930 N s/m");
  EXPECT_EQ(range_text(3.0, 3.0, "s"), "3 s");
  EXPECT_EQ(list_text(std::array{2e-5, 2.1e-5, 0.0}, "m"), "20, 21, 0 µm");
}

}  // namespace
}  // namespace zerocount::text
