// Words of commands that are written for people and for scripts, read by the shell itself.
#include "core/text/shell_word.hpp"

#include <array>
#include <cstdio>
#include <random>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace zerocount::text {
namespace {

std::string random_word(std::mt19937& random) {
  constexpr std::string_view characters = "ab-=,'\"\\ $`*?;&|<>()[]{}#!~%@\t\n\r\xc3\xa9";
  std::string word;
  for (std::size_t i = random() % 12; i > 0; --i) word += characters[random() % characters.size()];
  return word;
}

/// What the command prints, which `sh` reads.
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

TEST(ShellWord, IsLeftAsItIsWhereItNeedsNoQuotes) {
  EXPECT_EQ(shell_word("studies/axis-1.yaml"), "studies/axis-1.yaml");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(ShellPath, IsNoOption) {
  EXPECT_EQ(shell_path("-o.yaml"), "./-o.yaml");
  EXPECT_EQ(shell_path("-"), "-");
  EXPECT_EQ(shell_path("a b/-o.yaml"), "'a b/-o.yaml'");
}

}  // namespace
}  // namespace zerocount::text
