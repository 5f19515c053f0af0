#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/failure/failure.hpp"

namespace zerocount::command_line {

/// What a command does with the file that the value of an option names.
enum class FileUse {
  none,     ///< the value is not a path
  read,     ///< an input
  written,  ///< an output; an existing one is replaced only with --force
  kept,     ///< an output that people go on with, as results; as `written`, but it stays if the command fails
  page,     ///< a page; an unfinished one is replaced, and another only with --force
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
/// The option, whose value is the path of an output that stays if the command fails.
OptionSpec kept_file(OptionSpec option);
/// The option, whose value is the path of a page.
OptionSpec page_file(OptionSpec option);
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

// Options with numbers or design points as values.

/// A number strictly between 0 and 1, such as 0.95.
/// @throws Failure (bad_input) for anything else.
std::optional<double> probability_option(const Arguments& arguments, std::string_view option);

/// The number in the text of an option, finite and at least `least`, which may be −∞.
/// @throws Failure (bad_input) for anything else.
double number_from(const Arguments& arguments, std::string_view option, std::string_view text, double least);

/// The number of an option, as number_from() reads it; nothing if the option is missing.
std::optional<double> number_option(const Arguments& arguments, std::string_view option, double least);

/// The budget of a search: trials, or seconds; neither if the option is missing.
struct Budget {
  std::optional<std::int64_t> trials;
  std::optional<double> seconds;  ///< s
};

/// --budget: a number of trials, or a time such as 60s or 5min.
/// @throws Failure (bad_input) for anything else.
Budget budget_option(const Arguments& arguments);

/// The design points of --point, as study::point_named() reads them; empty if the option is missing.
/// @param labels of all points, in their order
/// @throws Failure (bad_input) for anything else.
std::vector<std::int64_t> point_options(const Arguments& arguments, std::span<const std::string> labels);

/// The two design points of `option`, given likewise.
std::optional<std::pair<std::int64_t, std::int64_t>> point_pair_option(const Arguments& arguments,
                                                                       std::string_view option,
                                                                       std::span<const std::string> labels);

/// As point_options, for an option that cannot be repeated.
std::optional<std::int64_t> point_option(const Arguments& arguments, std::span<const std::string> labels);

// Output files of the commands. An existing file is replaced only with --force.

/// The option --force of a command that writes.
OptionSpec force_option();

/// The rule, for the help of every command with --force.
inline constexpr std::string_view overwriting_rule =
    "An existing output is replaced only with --force, and only after the new one is complete.\n"
    "If the command fails, the output that was to be replaced is removed, unless it is a results\n"
    "file or the manifest of 'new', so that no earlier answer stands beside the failure.\n";

/// Compares the files of a command, as its options describe them, before any work. Two paths are the same
/// file where they lead to it, through links or a relative path, whether or not it exists.
/// @throws Failure (bad_input) if an output is an input or another output, or if two inputs are standard
/// input
void require_separate_files(const Arguments& arguments);

/// The outputs that the options of the command name.
std::vector<std::filesystem::path> outputs_of(const Arguments& arguments);

/// The refusal of an output that is also an input or another output, and so must stay as it is.
class RefusedOutput : public Failure {
 public:
  explicit RefusedOutput(const Failure& failure) : Failure(failure) {}
};

/// Outputs that exist before a command and that --force tells it to replace, without those that are kept
/// (FileUse::kept).
class EarlierAnswers {
 public:
  explicit EarlierAnswers(const Arguments& arguments);
  /// Removes the outputs that the command has not replaced, for when it has failed. Write-protected files
  /// stay.
  void remove_remaining() const;

 private:
  struct Answer {
    std::filesystem::path path;
    std::filesystem::file_time_type written;
  };
  std::vector<Answer> answers_;
};

/// The results file of --output. Checks before any work that its folder exists.
/// @throws Failure: bad_input if it names a folder, a link, a device or a pipe, or a file that exists, unless
/// --force is given or the option is of a renewed file; machine_failed if its folder does not exist.
std::filesystem::path output_place(const Arguments& arguments);

/// The text file of `option`, or "-" for standard output; nothing if the option is missing.
/// @throws Failure as output_place.
std::optional<std::filesystem::path> text_place(const Arguments& arguments, std::string_view option);

/// @throws Failure (bad_input) if `input`, which no option names, is one of the outputs.
void require_no_output(const Arguments& arguments, const std::filesystem::path& input,
                       std::span<const std::filesystem::path> outputs);

/// @throws Failure (bad_input) if `output`, which no option names, is one of the other outputs.
void require_apart(const Arguments& arguments, const std::filesystem::path& output,
                   std::span<const std::filesystem::path> others);

/// @throws Failure: bad_input if `output` exists and --force is not given; machine_failed if it is
/// write-protected.
void require_replaceable(const Arguments& arguments, const std::filesystem::path& output);

/// Writes to a file or stream from text_place().
/// @throws Failure (machine_failed) with the path and the system's reason.
void write_text(const std::filesystem::path& place, std::string_view text);

}  // namespace zerocount::command_line
