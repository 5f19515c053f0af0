// No command writes over one of its inputs, or two outputs into one file. The cases are made of the options
// that the commands declare, so that a new command or option is among them.
#include "core/failure/failure.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/program/commands.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;
using command_line::CommandSpec;
using command_line::FileUse;
using command_line::OptionSpec;

bool is_output(const OptionSpec& option) {
  return option.file != FileUse::none && option.file != FileUse::read;
}

/// The option of a command with this name.
const OptionSpec& option_named(const CommandSpec& spec, const std::string& name) {
  return *std::ranges::find(spec.options, name, command_line::long_name);
}

/// A command line with given options and values, and with the options that these need.
class Words {
 public:
  explicit Words(const CommandSpec& spec) : spec_(spec) {}

  void add(const OptionSpec& option, const std::string& value) {
    const std::string name = command_line::long_name(option);
    if (std::ranges::find(given_, name) != given_.end()) return;
    given_.push_back(name);
    words_.push_back("--" + name);
    if (!option.value.empty()) words_.insert(words_.end(), option.count, value);
    if (!option.operands.empty()) operand_ = option.operands.front();
    if (!option.needs.empty()) {
      const std::string need = option.needs.front().substr(0, option.needs.front().find('='));
      const std::size_t equals = option.needs.front().find('=');
      add(option_named(spec_, need),
          equals == std::string::npos ? "other" : option.needs.front().substr(equals + 1));
    }
  }

  /// The whole command line.
  /// @param input the operand that is a file
  std::vector<std::string> line(const std::string& input) const {
    std::vector<std::string> line{spec_.name};
    if (!spec_.operand_words.empty())
      line.push_back(operand_.empty() ? spec_.operand_words.front() : operand_);
    while (line.size() - 1 < std::max<std::size_t>(spec_.min_operands, 1) && spec_.max_operands > 0)
      line.push_back(input);
    line.insert(line.end(), words_.begin(), words_.end());
    return line;
  }

  /// Whether the option has no effect beside the options that are given.
  bool excluded(const OptionSpec& option) const {
    return std::ranges::any_of(option.excludes, [&](const std::string& condition) {
      return std::ranges::find(given_, condition.substr(0, condition.find('='))) != given_.end();
    });
  }

 private:
  const CommandSpec& spec_;
  std::vector<std::string> given_;
  std::vector<std::string> words_;
  std::string operand_;
};

/// The message about a command line that the program refuses with exit code 2; empty for other command lines.
std::string refusal(const std::vector<std::string>& line) {
  try {
    program::run_command_line(line);
  } catch (const Failure& failure) {
    return failure.code() == ExitCode::bad_input ? failure.what() : "";
  }
  return "";
}

class SeparateFiles : public ::testing::Test {
 protected:
  SeparateFiles() {
    fs::create_directory(folder_.path() / "sub");
    fs::create_directory_symlink(folder_.path(), folder_.path() / "link");
  }

  /// Different paths of the same file in the folder.
  std::vector<std::string> spellings(const std::string& name) const {
    const fs::path folder = folder_.path();
    return {folder / name, folder / "sub" / ".." / name, folder / "link" / name,
            fs::relative(folder, fs::current_path()) / name};
  }

  void expect_refused(const Words& words, const std::string& input, const std::string& problem) const {
    const std::string said = refusal(words.line(input));
    EXPECT_TRUE(says(said, problem)) << fmt::format("{}", fmt::join(words.line(input), " ")) << "\n  "
                                     << said;
  }

  TemporaryFolder folder_;
};

/// Calls `check` with each two options of a command of which neither excludes the other.
void for_pairs(const std::function<void(const CommandSpec&, const OptionSpec&, const OptionSpec&)>& check) {
  for (const commands::Command& command : program::commands()) {
    for (const OptionSpec& one : command.spec.options) {
      for (const OptionSpec& other : command.spec.options) {
        Words words(command.spec);
        words.add(one, "x");
        const bool fits = one.operands.empty() || other.operands.empty() || one.operands == other.operands;
        if (&one != &other && fits && !words.excluded(other)) check(command.spec, one, other);
      }
    }
  }
}

TEST_F(SeparateFiles, TwoOutputsMustBeDifferentFiles) {
  int pairs = 0;
  for_pairs([&](const CommandSpec& spec, const OptionSpec& one, const OptionSpec& other) {
    if (!is_output(one) || !is_output(other)) return;
    ++pairs;
    for (const std::string& spelling : spellings("out.html")) {
      Words words(spec);
      words.add(one, folder_.path() / "out.html");
      words.add(other, spelling);
      expect_refused(words, folder_.path() / "in.yaml", "is the name of two outputs");
    }
  });
  EXPECT_GE(pairs, 40);
}

TEST_F(SeparateFiles, AnOutputMustNotBeAnInputOfAnOption) {
  int pairs = 0;
  folder_.write("out.html", "");
  for_pairs([&](const CommandSpec& spec, const OptionSpec& one, const OptionSpec& other) {
    if (!is_output(one) || other.file != FileUse::read) return;
    ++pairs;
    for (const std::string& spelling : spellings("out.html")) {
      Words words(spec);
      words.add(one, spelling);
      words.add(other, folder_.path() / "out.html");
      expect_refused(words, folder_.path() / "in.yaml", "is an input and must not be overwritten");
    }
  });
  EXPECT_GE(pairs, 8);
}

TEST_F(SeparateFiles, AnOutputMustNotBeAnOperand) {
  folder_.write("out.html", "");
  fs::create_hard_link(folder_.path() / "out.html", folder_.path() / "hard.html");
  int outputs = 0;
  for (const commands::Command& command : program::commands()) {
    for (const OptionSpec& option : command.spec.options) {
      const bool names_file =
          command.spec.operand_words.empty() && command.spec.max_operands > 0 && is_output(option);
      if (!names_file) continue;
      ++outputs;
      std::vector<std::string> places = spellings("out.html");
      places.push_back(folder_.path() / "hard.html");
      for (const std::string& place : places) {
        Words words(command.spec);
        words.add(option, place);
        expect_refused(words, folder_.path() / "out.html", "is an input and must not be overwritten");
      }
    }
  }
  EXPECT_GE(outputs, 20);
}

// The check sees only what the options declare.
TEST_F(SeparateFiles, EveryFileOptionIsDeclaredAsOne) {
  const std::vector<std::string> names{"FILE", "DIR",      "PAGE", "TUNED",  "PICTURE",
                                       "PLOT", "MANIFEST", "DB",   "OUTPUT", "LIBRARY"};
  for (const commands::Command& command : program::commands()) {
    for (const OptionSpec& option : command.spec.options)
      EXPECT_EQ(option.file != FileUse::none, std::ranges::find(names, option.value) != names.end())
          << command.spec.name << " --" << option.name;
  }
}

TEST_F(SeparateFiles, DifferentFilesAndAStandardStreamPass) {
  const command_line::CommandSpec spec{"command",
                                       "FILE",
                                       {command_line::written_file({"output,o", "FILE", ""}),
                                        command_line::written_file({"plot", "FILE", ""}),
                                        command_line::read_file({"margins", "FILE", ""}),
                                        {"help,h", "", ""}}};
  const auto check = [&](std::vector<std::string> words) {
    command_line::require_separate_files({spec, words});
  };
  const std::string a = folder_.path() / "a", b = folder_.path() / "b", c = folder_.path() / "c";
  EXPECT_NO_THROW(check({a, "-o", b, "--plot", c}));
  EXPECT_NO_THROW(check({"-", "-o", "-"}));  // standard input, standard output
  EXPECT_NO_THROW(check({a, "--margins", a, "-o", b}));
  EXPECT_THROW(check({a, "-o", "-", "--plot", "-"}), Failure);
  EXPECT_THROW(check({"-", "--margins", "-"}), Failure);
}

}  // namespace
}  // namespace zerocount::testing
