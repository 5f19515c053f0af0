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

/// Use that a command makes of the file whose path is the value of an option.
enum class FileUse {
  none,     ///< The option's value is not a path.
  read,     ///< The command reads the file.
  written,  ///< The command writes the file. An existing file is replaced only with --force.
  /// The command writes the file, for example results. As `written`, but an earlier file stays if the command
  /// fails.
  kept,
  /// The command writes an HTML page. An unfinished page is replaced, any other file only with --force.
  page,
  renewed  ///< The command writes the file, and itself decides about an existing one.
};

/// One option of a command: `--name VALUE`, or a bare flag.
struct OptionSpec {
  std::string name;   ///< Long name such as "threads", or "output,o" with a short form.
  std::string value;  ///< Name of the value in the help, such as "FILE"; empty for a flag.
  std::string help;
  bool repeatable{false};
  std::size_t count{1};              ///< Number of values that follow the option.
  std::vector<std::string> words{};  ///< Allowed values, the default first; empty: any text is allowed.
  /// Other names of allowed values: other name → word of `words`. Not shown in the help.
  std::map<std::string, std::string> other_names{};
  /// Conditions, one of which must hold if the option is given; empty: none. A condition is the name of
  /// another option ("posterior"), or also its value ("format=json").
  std::vector<std::string> needs{};
  /// Conditions under which the option is refused, because it has no effect. A condition is the name of
  /// another option ("posterior"), or also its value ("format=json").
  std::vector<std::string> excludes{};
  /// First operands of the command with which the option is allowed; empty: any.
  std::vector<std::string> operands{};
  FileUse file{FileUse::none};
  /// Words that may occur in the value, which is then a comma-separated list; empty: the value is not a
  /// list.
  std::vector<std::string> list{};
};

// An option without an effect is an error. Those of one question among several say so where they are
// declared, and Arguments refuses them elsewhere. A condition is the name of an option, "posterior", or also
// its word, "format=json", which may be the default.

/// Returns the option, changed so that it is refused unless one of the conditions holds. A condition is the
/// name of another option, or also its value ("format=json").
OptionSpec needing(std::vector<std::string> conditions, OptionSpec option);
/// Returns the option, changed so that it is refused as without effect if one of the conditions holds. A
/// condition is the name of another option, or also its value ("format=json").
OptionSpec excluding(std::vector<std::string> conditions, OptionSpec option);
/// Returns the option, restricted to commands whose first operand is one of these words.
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
/// Returns the option with its value declared as the path of an HTML page that the command writes
/// (FileUse::page).
OptionSpec page_file(OptionSpec option);
/// Returns the option with its value declared as the path of an output about whose replacement the command
/// itself decides (FileUse::renewed).
OptionSpec renewed_file(OptionSpec option);

/// Makes an option whose value is one of `words`, the default first. The help of the option begins with the
/// words.
OptionSpec choice_option(std::string name, std::string value, std::vector<std::string> words,
                         const std::string& help = "");

/// Returns the option with its value declared as a comma-separated list of these words.
OptionSpec list_of(std::vector<std::string> words, OptionSpec option);

/// Option `--format`, which selects the format of the output, the first of `formats` by default.
OptionSpec format_option(std::vector<std::string> formats, const std::string& help = "");

/// Operands and options of a command. Operands are paths of files, except a first operand that is one of
/// operand_words.
struct CommandSpec {
  std::string name;
  std::string operands;  ///< Operands as the usage line shows them, e.g. "MANIFEST".
  std::vector<OptionSpec> options;
  std::size_t min_operands{1};
  std::size_t max_operands{1};
  /// Words that are allowed as first operand; empty: the first operand is a file.
  std::vector<std::string> operand_words{};
};

/// The parsed arguments of a command. All values are text.
class Arguments {
 public:
  /// Parses the words that follow the name of the command.
  /// @throws Failure (bad_input) that names the invalid argument and the help to read.
  Arguments(const CommandSpec& spec, const std::vector<std::string>& words);

  const CommandSpec& spec() const { return spec_; }
  const std::vector<std::string>& operands() const { return operands_; }
  bool has(std::string_view option) const { return !values(option).empty(); }
  /// Values of all occurrences of the option, in their order; "" for each occurrence of a flag. Empty without
  /// the option.
  const std::vector<std::string>& values(std::string_view option) const;
  std::optional<std::string> value(std::string_view option) const;
  std::string required(std::string_view option) const;
  /// Value of an option that has OptionSpec::words; the first word if the option is not given.
  std::string choice(std::string_view option) const;
  /// Value of an option that must be one of `words`; the first of them if the option is not given.
  std::string one_of(std::string_view option, const std::vector<std::string>& words) const;

  /// Use that the command makes of the file that the option names.
  FileUse file_use(std::string_view option) const;

  /// Whole number from low to high that the option has as value; nothing without the option.
  std::optional<std::int64_t> whole_number(std::string_view option, std::int64_t low,
                                           std::int64_t high) const;

  /// Throws Failure (bad_input) with the message "zerocount COMMAND: `problem`" and a pointer to the help.
  [[noreturn]] void refuse(const std::string& problem) const;

 private:
  void take_values(const OptionSpec& option, const std::vector<std::string>& words);
  bool holds(const std::string& condition) const;
  void refuse_without_effect(const OptionSpec& option) const;

  CommandSpec spec_;
  std::vector<std::string> operands_;
  std::vector<std::pair<std::string, std::vector<std::string>>> values_;
};

/// Long name of an option without its short form, such as "output" for "output,o".
std::string long_name(const OptionSpec& option);

/// Lines of the help that describe the options of a command.
std::string options_help(const CommandSpec& spec);

// Options with numbers or design points as values.

/// Value of an option that must be a number strictly between 0 and 1, such as 0.95; nothing without the
/// option.
/// @throws Failure (bad_input) for any other value.
std::optional<double> probability_option(const Arguments& arguments, std::string_view option);

/// Reads the text of an option's value as a finite number of at least `least`, which may be −∞.
/// @throws Failure (bad_input) for any other text.
double number_from(const Arguments& arguments, std::string_view option, std::string_view text, double least);

/// Value of an option as a finite number of at least `least`; nothing without the option.
/// @throws Failure (bad_input) for any other value.
std::optional<double> number_option(const Arguments& arguments, std::string_view option, double least);

/// Budget of a simulation command, in trials or in seconds. Both are empty if the option --budget is not
/// given.
struct Budget {
  std::optional<std::int64_t> trials;
  std::optional<double> seconds;
};

/// Value of the option --budget: a number of trials, or a time such as 60s or 5min. Both are empty without
/// the option.
/// @throws Failure (bad_input) for any other value.
Budget budget_option(const Arguments& arguments);

/// Indices of the design points that the option --point names, read by study::point_named(); empty without
/// the option.
/// @param labels labels of all design points, in their order
/// @throws Failure (bad_input) for any other value.
std::vector<std::int64_t> point_options(const Arguments& arguments, std::span<const std::string> labels);

/// Indices of the two design points that `option` names, read by study::point_named(); nothing without the
/// option.
/// @param labels labels of all design points, in their order
std::optional<std::pair<std::int64_t, std::int64_t>> point_pair_option(const Arguments& arguments,
                                                                       std::string_view option,
                                                                       std::span<const std::string> labels);

/// Index of the design point that a --point option names which cannot be repeated, read by
/// study::point_named(); nothing without the option.
/// @param labels labels of all design points, in their order
std::optional<std::int64_t> point_option(const Arguments& arguments, std::span<const std::string> labels);

// Output files of the commands. An existing file is replaced only with --force.

/// Option --force of a command that writes files: it lets the command replace existing ones.
OptionSpec force_option();

/// Text of the rule for existing outputs, for the help of every command with --force.
inline constexpr std::string_view overwriting_rule =
    "An existing output is replaced only with --force, and only after the new one is complete.\n"
    "If the command fails, the output that was to be replaced is removed, unless it is a results\n"
    "file or the manifest of 'new', so that no earlier answer stands beside the failure.\n";

/// Checks before any work that all files which a command reads and writes differ. OptionSpec::file says which
/// options name files. Two paths are the same file if they lead to the same place, through links or a
/// relative path, whether or not the file exists.
/// @throws Failure (bad_input) if an output is an input or another output, or if two inputs are standard
/// input
void require_separate_files(const Arguments& arguments);

/// Paths of all output files that the given options of the command name.
std::vector<std::filesystem::path> outputs_of(const Arguments& arguments);

/// Failure of a command whose output file is also an input or another output. Such a file must stay as it is.
class RefusedOutput : public Failure {
 public:
  explicit RefusedOutput(const Failure& failure) : Failure(failure) {}
};

/// Output files that exist before a command runs and that --force lets it replace. Files of FileUse::kept are
/// not among them.
class EarlierAnswers {
 public:
  explicit EarlierAnswers(const Arguments& arguments);
  /// Removes the old output files that the command has not replaced. Called after the command failed.
  /// Write-protected files stay.
  void remove_remaining() const;

 private:
  struct Answer {
    std::filesystem::path path;
    std::filesystem::file_time_type written;
  };
  std::vector<Answer> answers_;
};

/// Path of the results file that the option --output names. Checks before any work that its folder exists.
/// @throws Failure: bad_input if it names a folder, a link, a device or a pipe, or a file that exists, unless
/// --force is given or the option is of a renewed file; machine_failed if its folder does not exist.
std::filesystem::path output_place(const Arguments& arguments);

/// Path of the text file of `option`, or "-" for standard output; nothing without the option.
/// @throws Failure as output_place.
std::optional<std::filesystem::path> text_place(const Arguments& arguments, std::string_view option);

/// Checks that an input file which no option names is not also an output.
/// @param outputs paths of the outputs
/// @throws Failure (bad_input) if it is one of them
void require_no_output(const Arguments& arguments, const std::filesystem::path& input,
                       std::span<const std::filesystem::path> outputs);

/// Checks that an output file which no option names differs from other outputs.
/// @param others paths of the other outputs
/// @throws Failure (bad_input) if it is one of them
void require_apart(const Arguments& arguments, const std::filesystem::path& output,
                   std::span<const std::filesystem::path> others);

/// Checks that an output file may be written: it does not exist, or --force is given.
/// @throws Failure: bad_input if `output` exists and --force is not given; machine_failed if it is
/// write-protected
void require_replaceable(const Arguments& arguments, const std::filesystem::path& output);

/// Writes a text to the file or to standard output that text_place() returned.
/// @throws Failure (machine_failed) with the path and the system's reason.
void write_text(const std::filesystem::path& place, std::string_view text);

}  // namespace zerocount::command_line
