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

/// Use that a command makes of the file named by an option.
enum class FileUse {
  none,     ///< The value is not a path.
  read,     ///< Input.
  written,  ///< Output. An existing file is replaced only with --force.
  kept,     ///< Output such as results. As `written`, but an earlier file stays if the command fails.
  page,     ///< Page. An unfinished page is replaced, any other file only with --force.
  renewed   ///< Output. The command itself decides about an existing file.
};

/// One option of a command: `--name VALUE`, or a bare flag.
struct OptionSpec {
  std::string name;   ///< "threads", or "output,o" with a short form
  std::string value;  ///< Name of the value in the help; empty for a flag.
  std::string help;
  bool repeatable{false};
  std::size_t count{1};                              ///< Number of values.
  std::vector<std::string> words{};                  ///< Allowed values, the default first; empty: any text.
  std::map<std::string, std::string> other_names{};  ///< Other name → word of `words`; not in the help.
  std::vector<std::string> needs{};     ///< The option needs one of these conditions; empty: none.
  std::vector<std::string> excludes{};  ///< The option has no effect if one of these conditions holds.
  std::vector<std::string> operands{};  ///< The option needs one of these as first operand; empty: any.
  FileUse file{FileUse::none};
  std::vector<std::string>
      list{};  ///< Words of which the value is a comma-separated list; empty: the value is not a list.
};

// An option without an effect is an error. Those of one question among several say so where they are
// declared, and Arguments refuses them elsewhere. A condition is the name of an option, "posterior", or also
// its word, "format=json", which may be the default.

/// Returns the option with the requirement that one of the conditions holds.
OptionSpec needing(std::vector<std::string> conditions, OptionSpec option);
/// Returns the option with the note that it has no effect if one of the conditions holds.
OptionSpec excluding(std::vector<std::string> conditions, OptionSpec option);
/// Returns the option restricted to these first operands.
OptionSpec of_operands(std::vector<std::string> operands, OptionSpec option);

// An option with a file says what becomes of the file: require_separate_files() compares all files of a
// command.

/// Returns the option with its value declared as the path of an input (FileUse::read).
OptionSpec read_file(OptionSpec option);
/// Returns the option with its value declared as the path of an output (FileUse::written).
OptionSpec written_file(OptionSpec option);
/// Returns the option with its value declared as the path of an output that stays if the command fails
/// (FileUse::kept).
OptionSpec kept_file(OptionSpec option);
/// Returns the option with its value declared as the path of a page (FileUse::page).
OptionSpec page_file(OptionSpec option);
/// Returns the option with its value declared as the path of an output that may exist (FileUse::renewed).
OptionSpec renewed_file(OptionSpec option);

/// Option whose value is one of `words`, the default first. The help of the option begins with the words.
OptionSpec choice_option(std::string name, std::string value, std::vector<std::string> words,
                         const std::string& help = "");

/// Returns the option with its value declared as a comma-separated list of these words.
OptionSpec list_of(std::vector<std::string> words, OptionSpec option);

/// Option `--format`, the format of the output.
OptionSpec format_option(std::vector<std::string> formats, const std::string& help = "");

/// Operands and options of a command. Operands are files, except a first operand that is one of
/// operand_words.
struct CommandSpec {
  std::string name;
  std::string operands;  ///< Operands as the usage line shows them, e.g. "MANIFEST".
  std::vector<OptionSpec> options;
  std::size_t min_operands{1};
  std::size_t max_operands{1};
  std::vector<std::string> operand_words{};  ///< Allowed first operands; empty: the first operand is a file.
};

/// The parsed arguments of a command. All values are text.
class Arguments {
 public:
  /// @throws Failure (bad_input) that names the invalid argument and the help to read.
  Arguments(const CommandSpec& spec, const std::vector<std::string>& words);

  const CommandSpec& spec() const { return spec_; }
  const std::vector<std::string>& operands() const { return operands_; }
  bool has(std::string_view option) const { return !values(option).empty(); }
  const std::vector<std::string>& values(std::string_view option) const;  ///< All occurrences; "" for a flag.
  std::optional<std::string> value(std::string_view option) const;
  std::string required(std::string_view option) const;
  /// Value of an option with OptionSpec::words; without the option, the first word.
  std::string choice(std::string_view option) const;
  /// Value of an option that must be one of `words`; without the option, the first of `words`.
  std::string one_of(std::string_view option, const std::vector<std::string>& words) const;

  /// Use of the file of an option.
  FileUse file_use(std::string_view option) const;

  /// Whole number of an option, in [low, high]; nothing without the option.
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

/// Long name of an option, such as "output" for "output,o".
std::string long_name(const OptionSpec& option);

/// Help lines of the options of `spec`.
std::string options_help(const CommandSpec& spec);

// Options with numbers or design points as values.

/// Number of an option, strictly between 0 and 1, such as 0.95; nothing without the option.
/// @throws Failure (bad_input) for anything else.
std::optional<double> probability_option(const Arguments& arguments, std::string_view option);

/// The number in the text of an option, finite and at least `least`, which may be −∞.
/// @throws Failure (bad_input) for anything else.
double number_from(const Arguments& arguments, std::string_view option, std::string_view text, double least);

/// The number of an option, as number_from() reads it; nothing if the option is missing.
std::optional<double> number_option(const Arguments& arguments, std::string_view option, double least);

/// Budget of a search, in trials or in seconds. Both are empty if the option is missing.
struct Budget {
  std::optional<std::int64_t> trials;
  std::optional<double> seconds;
};

/// Value of the option --budget: a number of trials, or a time such as 60s or 5min.
/// @throws Failure (bad_input) for anything else.
Budget budget_option(const Arguments& arguments);

/// Design points of the option --point, as study::point_named() reads them; empty without the option.
/// @param labels of all points, in their order
/// @throws Failure (bad_input) for anything else.
std::vector<std::int64_t> point_options(const Arguments& arguments, std::span<const std::string> labels);

/// The two design points of `option`, as study::point_named() reads them; nothing without the option.
std::optional<std::pair<std::int64_t, std::int64_t>> point_pair_option(const Arguments& arguments,
                                                                       std::string_view option,
                                                                       std::span<const std::string> labels);

/// Design point of a --point option that cannot be repeated, as study::point_named() reads it; nothing
/// without the option.
std::optional<std::int64_t> point_option(const Arguments& arguments, std::span<const std::string> labels);

// Output files of the commands. An existing file is replaced only with --force.

/// Option --force of a command that writes.
OptionSpec force_option();

/// Rule for existing outputs, for the help of every command with --force.
inline constexpr std::string_view overwriting_rule =
    "An existing output is replaced only with --force, and only after the new one is complete.\n"
    "If the command fails, the output that was to be replaced is removed, unless it is a results\n"
    "file or the manifest of 'new', so that no earlier answer stands beside the failure.\n";

/// Checks before any work that the files of a command differ. OptionSpec::file describes their use. Two paths
/// are the same file if they lead to the same place, through links or a relative path, whether or not the
/// file exists.
/// @throws Failure (bad_input) if an output is an input or another output, or if two inputs are standard
/// input
void require_separate_files(const Arguments& arguments);

/// Paths of all outputs that the options of the command name.
std::vector<std::filesystem::path> outputs_of(const Arguments& arguments);

/// Failure for an output that is also an input or another output. Such a file must stay as it is.
class RefusedOutput : public Failure {
 public:
  explicit RefusedOutput(const Failure& failure) : Failure(failure) {}
};

/// Outputs that exist before a command and that --force lets it replace. Files of FileUse::kept are not among
/// them.
class EarlierAnswers {
 public:
  explicit EarlierAnswers(const Arguments& arguments);
  /// Removes the outputs that the command has not replaced. Called after a failure. Write-protected files
  /// stay.
  void remove_remaining() const;

 private:
  struct Answer {
    std::filesystem::path path;
    std::filesystem::file_time_type written;
  };
  std::vector<Answer> answers_;
};

/// Path of the results file of --output. Checks before any work that its folder exists.
/// @throws Failure: bad_input if it names a folder, a link, a device or a pipe, or a file that exists, unless
/// --force is given or the option is of a renewed file; machine_failed if its folder does not exist.
std::filesystem::path output_place(const Arguments& arguments);

/// Path of the text file of `option`, or "-" for standard output; nothing without the option.
/// @throws Failure as output_place.
std::optional<std::filesystem::path> text_place(const Arguments& arguments, std::string_view option);

/// Checks that an input, which no option names, is not an output.
/// @throws Failure (bad_input) if it is one of the outputs
void require_no_output(const Arguments& arguments, const std::filesystem::path& input,
                       std::span<const std::filesystem::path> outputs);

/// Checks that an output, which no option names, differs from other outputs.
/// @throws Failure (bad_input) if it is one of them
void require_apart(const Arguments& arguments, const std::filesystem::path& output,
                   std::span<const std::filesystem::path> others);

/// Checks that an output may be written.
/// @throws Failure: bad_input if `output` exists and --force is not given; machine_failed if it is
/// write-protected
void require_replaceable(const Arguments& arguments, const std::filesystem::path& output);

/// Writes to a file or stream from text_place().
/// @throws Failure (machine_failed) with the path and the system's reason.
void write_text(const std::filesystem::path& place, std::string_view text);

}  // namespace zerocount::command_line
