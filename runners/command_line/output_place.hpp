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

/// The results file of --output. Checks before any work that its folder exists.
/// @throws Failure: bad_input if it names a folder, a link, a device or a pipe;
/// machine_failed if its folder does not exist.
std::filesystem::path output_place(const Arguments& arguments);

/// The text file of `option`, or "-" for standard output; nothing if the option is missing.
/// @throws Failure as output_place.
std::optional<std::filesystem::path> text_place(const Arguments& arguments, std::string_view option);

/// @throws Failure (bad_input) if `output` is one of the inputs.
void require_no_input(const Arguments& arguments, const std::filesystem::path& output,
                      std::span<const std::filesystem::path> inputs);

/// @throws Failure (bad_input) if `output` is another output, whether or not it exists.
void require_apart(const Arguments& arguments, const std::filesystem::path& output,
                   std::span<const std::filesystem::path> others);

/// Checks the input and output files of a verb before any work; "-" means a standard stream.
/// @throws Failure (bad_input) if two inputs are standard input, or if an output is an input, another
/// output, or exists and --force is not given.
void require_places(const Arguments& arguments, const std::vector<std::filesystem::path>& inputs,
                    const std::vector<std::filesystem::path>& outputs);

/// Writes to a file or stream from text_place().
/// @throws Failure (machine_failed) with the path and the system's reason.
void write_text(const std::filesystem::path& place, std::string_view text);

}  // namespace zerocount::command_line
