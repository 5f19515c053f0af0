// The README's first study: its manifest and its commands do what it says of them.
#include <algorithm>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

/// The part of the README under this heading.
std::string section(const std::string& heading) {
  std::ifstream file(ZEROCOUNT_README);
  std::ostringstream text;
  text << file.rdbuf();
  const std::string all = text.str();
  const std::size_t start = all.find("\n## " + heading + "\n");
  if (start == std::string::npos) return {};
  return all.substr(start, all.find("\n## ", start + 1) - start);
}

/// The first fenced block of the language in the text.
std::string block(const std::string& text, const std::string& language) {
  const std::string fence = "```" + language + "\n";
  const std::size_t start = text.find(fence);
  if (start == std::string::npos) return {};
  const std::size_t first = start + fence.size();
  return text.substr(first, text.find("```", first) - first);
}

/// The words of a command line without its comment.
std::vector<std::string> words_of(const std::string& line) {
  std::istringstream text(line.substr(0, line.find(" #")));
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  return words;
}

class FirstStudy : public ::testing::Test {
 protected:
  FirstStudy() : text_(section("A first study of your own")) {
    folder_.write("my-axis.yaml", block(text_, "yaml"));
  }
  ProgramResult run(const std::vector<std::string>& words) const {
    return zerocount_program(words, folder_.path());
  }

  std::string text_;
  TemporaryFolder folder_;
};

TEST_F(FirstStudy, IsUnderstoodWithoutWarnings) {
  ASSERT_NE(folder_.read("my-axis.yaml").find("name: my-axis"), std::string::npos) << text_;
  const ProgramResult checked = run({"check", "my-axis.yaml"});
  EXPECT_EQ(checked.code, 0);
  EXPECT_EQ(checked.err, "");
  EXPECT_NE(checked.out.find("8 design points × 2000 trials"), std::string::npos) << checked.out;
  EXPECT_NE(checked.out.find("100 rigs × 20 trials of each"), std::string::npos) << checked.out;
}

TEST_F(FirstStudy, ItsCommandsWork) {
  std::istringstream lines(block(text_, "sh"));
  std::vector<std::string> verbs;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> words = words_of(line);
    ASSERT_FALSE(words.empty());
    EXPECT_EQ(words.front(), "build/release/zerocount") << line;
    words.erase(words.begin());
    ASSERT_FALSE(words.empty()) << line;
    verbs.push_back(words.front());
    if (words.front() == "run") words.insert(words.end(), {"--quiet", "--set", "trials=100"});
    const ProgramResult result = run(words);
    EXPECT_EQ(result.code, 0) << line << "\n" << result.err;
  }
  EXPECT_EQ(verbs, (std::vector<std::string>{"check", "run", "summary", "report"}));
  EXPECT_NE(folder_.read("my-axis.html").find("</html>"), std::string::npos);

  const auto summary = nlohmann::json::parse(run({"summary", "my-axis.h5", "--format", "json"}).out);
  ASSERT_EQ(summary["points"].size(), 8U);
  const auto rate = [&](std::size_t point) { return summary["points"][point]["success_rate"].get<double>(); };
  EXPECT_GT(rate(0), rate(7));  // a higher integral gain, and fewer moves that hold zero counts
}

}  // namespace
}  // namespace zerocount::testing
