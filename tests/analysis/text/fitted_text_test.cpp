#include "analysis/text/fitted_text.hpp"

#include "analysis/text/text.hpp"
#include "tests/support/test.hpp"

namespace zerocount::text {
namespace {

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
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) {
    if (word.rfind("─", 0) != 0) words.push_back(word);
  }
  std::sort(words.begin(), words.end());
  return words;
}

/// A table of words, of which each is there once.
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
    std::vector<std::string> words = words_of(shown), expected = words_of(table);
    words.erase(std::unique(words.begin(), words.end()), words.end());
    EXPECT_EQ(words, expected);
  }
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
  EXPECT_EQ(words_of(fitted(sentence, 40)), words_of(sentence));
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
  EXPECT_EQ(words_of(unwrapped(by_hand, 10)), words_of(by_hand));
}

TEST(FittedText, KeepsALineWithoutABreakAtItsEnd) {
  EXPECT_EQ(fitted("short", 80), "short");
  EXPECT_EQ(fitted("", 80), "");
  EXPECT_EQ(fitted("\n\n", 80), "\n\n");
}

}  // namespace
}  // namespace zerocount::text
