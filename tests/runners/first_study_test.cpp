// The README's first study: its manifest and its commands do what it says of them.

#include "analysis/basis/text/text.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

/// The section of the README under this heading.
std::string section(const std::string& heading) {
  std::ifstream file(ZEROCOUNT_README);
  std::ostringstream text;
  text << file.rdbuf();
  const std::string all = text.str();
  const std::size_t start = all.find("\n## " + heading + "\n");
  if (start == std::string::npos) return {};
  return all.substr(start, all.find("\n## ", start + 1) - start);
}

/// The first fenced code block of the given language in the text.
std::string block(const std::string& text, const std::string& language) {
  const std::string fence = "```" + language + "\n";
  const std::size_t start = text.find(fence);
  if (start == std::string::npos) return {};
  const std::size_t first = start + fence.size();
  return text.substr(first, text.find("```", first) - first);
}

/// The words of a command line without its comment.
std::vector<std::string> split_command(const std::string& line) {
  std::istringstream text(line.substr(0, line.find(" #")));
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  return words;
}

class FirstStudy : public ProgramTest {
 protected:
  FirstStudy() : text_(section("A first study of your own")) {
    folder_.write("my-axis.yaml", block(text_, "yaml"));
  }
  /// The design points in the JSON summary of a results file.
  nlohmann::json points_of(const std::string& file) const {
    return nlohmann::json::parse(program({"summary", file, "--format", "json"}).out)["points"];
  }

  std::string text_;
};

TEST_F(FirstStudy, IsReadWithoutWarnings) {
  ASSERT_NE(folder_.read("my-axis.yaml").find("name: my-axis"), std::string::npos) << text_;
  const ProgramResult checked = program({"check", "my-axis.yaml"});
  EXPECT_EQ(checked.code, 0);
  EXPECT_EQ(checked.err, "");
  EXPECT_TRUE(says(checked.out, "8 design points × 2000 trials", "1000, 2 trials of each"));
}

/// A proportion as percentage, formatted as in the README.
std::string percent(double proportion) {
  return fmt::format("{:.1f}", 100.0 * proportion);
}

/// The success rate of a design point with its bounds, formatted as in the table and the README.
std::string success_of(const nlohmann::json& point) {
  const auto part = [&point](const char* name) { return point[name].get<double>(); };
  return fmt::format("{} % [{}]", percent(part("success_rate")),
                     text::percent_bounds(part("success_rate_low"), part("success_rate_high")));
}

// The whole study, as the reader runs it, and what the README says of it.
TEST_F(FirstStudy, ItsCommandsPrintWhatTheReadmeSays) {
  std::istringstream lines(block(text_, "sh"));
  std::vector<std::string> commands;
  std::string table;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> words = split_command(line);
    ASSERT_FALSE(words.empty());
    EXPECT_EQ(words.front(), "build/release/zerocount") << line;
    words.erase(words.begin());
    ASSERT_FALSE(words.empty()) << line;
    commands.push_back(words.front());
    if (words.front() == "run") words.insert(words.end(), {"--quiet"});
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 0) << line << "\n" << result.err;
    if (words.front() == "summary") table = result.out;
  }
  EXPECT_EQ(commands, (std::vector<std::string>{"check", "run", "summary", "judge", "report"}));
  EXPECT_TRUE(says(folder_.read("my-axis.html"), "</html>"));

  std::istringstream rows(block(text_, "text"));
  for (std::string row; std::getline(rows, row);) EXPECT_TRUE(says(table, row + "\n")) << row;

  const auto points = points_of("my-axis.h5");
  ASSERT_EQ(points.size(), 8U);
  // Only the numbers are compared, so that the sentences may be reworded.
  std::string text = text_.substr(text_.find("The goal is met at the best"));
  text = text.substr(0, text.find("\n\n"));
  std::replace(text.begin(), text.end(), '\n', ' ');
  const auto expect_said = [&text](const std::string& words) { EXPECT_TRUE(says(text, words)) << words; };
  const auto expect_percent = [&](const std::string& number) { expect_said(" " + number + " %"); };
  const auto judged = nlohmann::json::parse(program({"judge", "my-axis.h5", "--format", "json"}).out);
  EXPECT_EQ(judged["point"], 2);
  EXPECT_EQ(judged["status"], "met");
  expect_percent(percent(judged["rate"].get<double>()));
  expect_said(" " + text::percent_at_least(judged["rate_low"].get<double>()));
  expect_said(fmt::format("{} of the 1000 machines", points[2]["goal"]["machines_without_miss"].get<int>()));
  expect_said(fmt::format("({} %)", percent(points[0]["goal"]["rate"].get<double>())));
  expect_percent(percent(points[4]["prediction"]["stable_share"].get<double>()));
  expect_percent(percent(points[4]["stable_rate"].get<double>()));
  expect_said(success_of(points[2]));
  EXPECT_EQ(points[2]["zero_count"].get<int>() + points[2]["one_count"].get<int>(), 2000);
}

/// Override that keeps only the best gain of the sweep.
constexpr const char* best_gain = "sweep={grid: {controller.ki: [1.1768e+4]}}";

// Premises that docs/reliability.md names, by night: of the position the answer survives them, of the reading
// it does not.
TEST_F(FirstStudy, DISABLED_ItsAnswerHoldsUnderTheAssumptionsOfItsPage) {
  const auto judged_with = [this](const std::vector<std::string>& settings) {
    std::vector<std::string> words{"run",     "my-axis.yaml", "-o",    "other.h5",
                                   "--quiet", "--force",      "--set", best_gain};
    for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
    EXPECT_EQ(program(words).code, 0);
    return nlohmann::json::parse(program({"judge", "other.h5", "--format", "json"}).out);
  };
  const auto judged = judged_with({"controller.delay=2"});
  EXPECT_EQ(judged["status"], "met");
  EXPECT_GE(judged["rate"].get<double>(), 0.962);
  EXPECT_LE(judged["rate"].get<double>(), 0.982);
  EXPECT_EQ(judged_with({"friction.k1={lognormal: {median: 90, cv: 0.4}}"})["status"], "missed");
  const std::string noisy = "encoder.fine_errors.noise=0.4";
  EXPECT_EQ(judged_with({noisy})["status"], "met");
  EXPECT_EQ(judged_with({noisy, "goal={band: 1, within: 0.05, moves: 0.95}"})["status"], "missed");
}

TEST_F(FirstStudy, NoiseAndCreepPreventZeroCounts) {
  const auto zero_counts = [this](const std::vector<std::string>& settings) {
    std::vector<std::string> words{"run",     "my-axis.yaml", "-o",      "still.h5", "--quiet",
                                   "--force", "--set",        best_gain, "--set",    "trials=1000"};
    for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
    EXPECT_EQ(program(words).code, 0);
    return points_of("still.h5")[0]["success_rate"].get<double>();
  };
  const std::string quiet = "encoder.fine_errors.noise=0";
  EXPECT_LT(zero_counts({}), 0.45);
  EXPECT_EQ(zero_counts({quiet, "friction.alpha=0"}), 1.0);
  const double creeping = zero_counts({quiet});
  EXPECT_LT(creeping, 0.8);
  EXPECT_GT(zero_counts({quiet, "command.hold=2"}), creeping + 0.1) << "jerks become rarer";
}

}  // namespace
}  // namespace zerocount::testing
