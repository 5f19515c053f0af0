// docs/round-trip.md: its commands, run in the order of the page, print what it says.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

/// A fenced code block of a documentation page.
struct Block {
  std::string language;  ///< yaml or sh; empty for the output of the commands before it
  std::string text;
};

std::vector<Block> blocks_of(const std::string& page) {
  std::vector<Block> blocks;
  bool inside = false;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) blocks.push_back({line.substr(3), {}});
    } else if (inside) {
      blocks.back().text += line + "\n";
    }
  }
  return blocks;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Whether a line begins with the words of the expected line, and with numbers that agree to a factor of 1.5,
/// because another processor may round differently.
bool begins_like(const std::string& found, const std::string& expected) {
  std::istringstream found_words(found);
  std::istringstream expected_words(expected);
  std::string one;
  for (std::string other; expected_words >> other;) {
    if (!(found_words >> one)) return false;
    char* end = nullptr;
    const double number = std::strtod(other.c_str(), &end);
    const double ratio = std::strtod(one.c_str(), nullptr) / number;
    const bool alike = end == other.c_str() || number == 0.0
                           ? one == other
                           : std::abs(std::log(ratio)) <= std::log(1.5);  // false if it is not a number
    if (!alike) return false;
  }
  return true;
}

/// The text "A to B" with the two numbers directly before the mark on a page (tests/claims/marks.py); empty
/// if the page lacks the mark.
std::string range_before(const std::string& page, const std::string& mark) {
  std::istringstream text(page.substr(0, page.find(mark)));
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  if (page.find(mark) == std::string::npos || words.size() < 3) return {};
  return fmt::format("{}", fmt::join(words.end() - 3, words.end(), " "));
}

class RoundTripPage : public ::testing::Test {
 protected:
  /// Runs the commands by the shell, which stops at the first that fails, and returns what they print.
  std::string printed_by(const std::string& commands) {
    folder_.write("commands.sh", commands);
    const std::string programs = std::filesystem::path(ZEROCOUNT_PROGRAM).parent_path().string();
    const std::string line = "cd '" + folder_.path().string() + "' && PATH='" + programs +
                             "':\"$PATH\" CPATH='" ZEROCOUNT_PLUGIN_HEADERS
                             "' sh -e commands.sh > printed.txt 2> errors.txt";
    EXPECT_EQ(std::system(line.c_str()), 0) << commands << folder_.read("errors.txt");
    return folder_.read("printed.txt");
  }

  std::int64_t successes_in(const std::string& file) {
    const ProgramResult summary = zerocount_program({"summary", file, "--format", "json"}, folder_.path());
    return nlohmann::json::parse(summary.out)["points"][0]["zero_count"];
  }

  /// The text "A to B" with the numbers of successes of the central 95 % of the simulated machines at the
  /// design point.
  std::string predicted_range(std::size_t point) {
    const std::optional<reading::StoredGroups> machines =
        reading::AllTrialsFile(folder_ / "predicted.h5").groups("machine");
    const auto count = static_cast<std::ptrdiff_t>(machines.value().count);
    std::vector<std::int64_t> successes = machines->success;
    successes = {successes.begin() + static_cast<std::ptrdiff_t>(point) * count,
                 successes.begin() + static_cast<std::ptrdiff_t>(point + 1) * count};
    std::ranges::sort(successes);
    const std::ptrdiff_t beyond = count / 40;
    return fmt::format("{} to {}", successes[static_cast<std::size_t>(beyond)],
                       successes[static_cast<std::size_t>(count - 1 - beyond)]);
  }

  TemporaryFolder folder_;
};

TEST_F(RoundTripPage, DISABLED_CommandsPrintWhatThePageShows) {
  const std::string page = read_bytes(ZEROCOUNT_ROUND_TRIP_PAGE);
  std::string printed;
  for (const Block& block : blocks_of(page)) {
    if (block.language == "yaml") {
      folder_.write(block.text.substr(2, block.text.find(':') - 2), block.text);  // # NAME: what it is
    } else if (block.language == "sh") {
      printed = printed_by(block.text);
      if (HasFailure()) return;
    } else {
      const std::vector<std::string> found = lines_of(printed);
      auto next = found.begin();
      for (const std::string& line : lines_of(block.text)) {
        next =
            std::find_if(next, found.end(), [&](const std::string& one) { return begins_like(one, line); });
        ASSERT_NE(next, found.end()) << "\"" << line << "\" is not in\n" << printed;
      }
    }
  }
  // The counts that the page gives to `observed` are those of the machine.
  const auto predicted = nlohmann::json::parse(
      zerocount_program({"summary", "predicted.h5", "--format", "json"}, folder_.path()).out);
  ASSERT_EQ(predicted["points"].size(), 2u);
  const std::vector<std::string> moves{"moves-2.521e+4.h5", "moves-8.0e+4.h5"};
  for (std::size_t point = 0; point < 2; ++point) {
    const auto& observed = predicted["points"][point]["observed_counts"];
    EXPECT_EQ(observed["successes"], successes_in(moves[point]));
    EXPECT_EQ(observed["of"], 40);
    EXPECT_EQ(observed["verdict"], "consistent");
  }
  const std::string stated = range_before(page, "<!-- claim: round-trip-predicted -->");
  EXPECT_TRUE(begins_like(stated, predicted_range(1))) << predicted_range(1) << "; stated: " << stated;
}

}  // namespace
}  // namespace zerocount::testing
