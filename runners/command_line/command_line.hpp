#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount::command_line {

/// What a command does with the file that the value of an option names.
enum class FileUse {
  none,     ///< the value is not a path
  read,     ///< an input
  written,  ///< an output; an existing one is replaced only with --force
  renewed   ///< an output of which the command itself decides what becomes of an existing one
};

/// One option of a command: `--name VALUE`, or a bare flag.
struct OptionSpec {
  std::string name;   ///< "threads", or "output,o" with a short form
  std::string value;  ///< name of its value in the help; empty for a flag
  std::string help;
  bool repeatable{false};
  std::size_t count{1};              ///< number of its values
  std::vector<std::string> words{};  ///< its allowed values, the default first; empty: any text
  std::map<std::string, std::string> other_names{};  ///< name → the word that it stands for; not in the help
  std::vector<std::string> needs{};     ///< it has an effect only beside one of these; empty: always
  std::vector<std::string> excludes{};  ///< it has none beside any of these
  std::vector<std::string> operands{};  ///< it has one only with such a first operand; empty: with all
  FileUse file{FileUse::none};
  std::vector<std::string>
      list{};  ///< words of which its value is a list, with commas between, or one of them
};

// An option without an effect is an error. Those of one question among several say so where they are
// declared, and Arguments refuses them elsewhere. A condition is the name of an option, "posterior", or also
// its word, "format=json", which may be the default.

/// The option, which needs one of the conditions.
OptionSpec needing(std::vector<std::string> conditions, OptionSpec option);
/// The option, which has no effect beside one of the conditions.
OptionSpec excluding(std::vector<std::string> conditions, OptionSpec option);
/// The option, which belongs to these first operands.
OptionSpec of_operands(std::vector<std::string> operands, OptionSpec option);

// An option with a file says what becomes of the file: require_separate_files() compares all files of a
// command.

/// The option, whose value is the path of an input.
OptionSpec read_file(OptionSpec option);
/// The option, whose value is the path of an output.
OptionSpec written_file(OptionSpec option);
/// The option, whose value is the path of an output that may exist.
OptionSpec renewed_file(OptionSpec option);

/// An option whose value is one of `words`, the default first; its help begins with them.
OptionSpec choice_option(std::string name, std::string value, std::vector<std::string> words,
                         const std::string& help = "");

/// The option, whose value is a list of these words with commas between.
OptionSpec list_of(std::vector<std::string> words, OptionSpec option);

/// `--format`, the form of what is printed.
OptionSpec format_option(std::vector<std::string> formats, const std::string& help = "");

/// Operands and options of a command. Operands are files, except a first one that is one of the words.
struct CommandSpec {
  std::string name;
  std::string operands;  ///< as the usage line shows them, e.g. "MANIFEST"
  std::vector<OptionSpec> options;
  std::size_t min_operands{1};
  std::size_t max_operands{1};
  std::vector<std::string> operand_words{};  ///< allowed first operands; empty: a file
};

/// The parsed arguments of a command. All values are text.
class Arguments {
 public:
  /// @throws Failure (bad_input) that names the invalid argument and the help to read.
  Arguments(const CommandSpec& spec, const std::vector<std::string>& words);

  const CommandSpec& spec() const { return spec_; }
  const std::vector<std::string>& operands() const { return operands_; }
  bool has(std::string_view option) const { return !values(option).empty(); }
  const std::vector<std::string>& values(std::string_view option) const;  ///< all occurrences; "" for a flag
  std::optional<std::string> value(std::string_view option) const;
  std::string required(std::string_view option) const;
  std::string choice(std::string_view option) const;  ///< of an option with words; default: the first
  std::string one_of(std::string_view option,
                     const std::vector<std::string>& words) const;  ///< default: the first of `words`

  /// Use of the file of an option.
  FileUse file_use(std::string_view option) const;

  /// A whole number in [low, high].
  std::optional<std::int64_t> whole_number(std::string_view option, std::int64_t low,
                                           std::int64_t high) const;

  /// Throws Failure (bad_input): "zerocount COMMAND: `problem`", with a pointer to the help.
  [[noreturn]] void refuse(const std::string& problem) const;

 private:
  void take_values(const OptionSpec& option, const std::vector<std::string>& words);
  bool holds(const std::string& condition) const;
  void refuse_without_effect(const OptionSpec& option) const;

  CommandSpec spec_;
  std::vector<std::string> operands_;
  std::vector<std::pair<std::string, std::vector<std::string>>> values_;
};

/// "output" of the option "output,o".
std::string long_name(const OptionSpec& option);

/// The options of `spec` as lines of help.
std::string options_help(const CommandSpec& spec);

}  // namespace zerocount::command_line
