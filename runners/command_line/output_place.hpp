#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "runners/command_line/command_line.hpp"

/// Where verbs write. One rule holds for all: what exists already is replaced with --force only.
namespace zerocount {

/// The option --force of a verb that writes.
OptionSpec force_option();

/// The rule, for the help of every verb with --force.
inline constexpr std::string_view overwriting_rule =
    "An output that exists already is not replaced without --force, and never lost before its\n"
    "successor is whole.\n";

/// The results file that --output names, in a folder that exists: asked before any work is done.
/// @throws Failure: bad_input where it names no file, machine_failed where its folder is not there.
std::filesystem::path output_place(const Arguments& arguments);

/// The text file that `option` names, which may be "-" for standard output; none where it is not given.
/// @throws Failure as output_place.
std::optional<std::filesystem::path> text_place(const Arguments& arguments, std::string_view option);

/// Checks the places of a verb before it does any work: "-" among them stands for a standard stream.
/// @throws Failure (bad_input) where two inputs are standard input; where an output is an input, another
/// output, or no regular file, or exists and --force is not given.
void require_places(const Arguments& arguments, const std::vector<std::filesystem::path>& inputs,
                    const std::vector<std::filesystem::path>& outputs);

/// Writes to a place from text_place().
/// @throws Failure (machine_failed) with the path and the system's reason.
void write_text(const std::filesystem::path& place, std::string_view text);

}  // namespace zerocount
