#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runners/command_line/command_line.hpp"

/// Output files of the verbs. An existing file is replaced only with --force.
namespace zerocount::command_line {

/// The option --force of a verb that writes.
OptionSpec force_option();

/// The rule, for the help of every verb with --force.
inline constexpr std::string_view overwriting_rule =
    "An existing output is replaced only with --force, and only after the new one is complete.\n";

/// Compares the files of a command, as its options describe them, before any work. Two paths are the same
/// file where they lead to it, through links or a relative path, whether or not it exists.
/// @throws Failure (bad_input) if an output is an input or another output, or if two inputs are standard
/// input
void require_separate_files(const Arguments& arguments);

/// The outputs that the options of the command name.
std::vector<std::filesystem::path> outputs_of(const Arguments& arguments);

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
