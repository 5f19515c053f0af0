#pragma once

#include <filesystem>
#include <vector>

#include "runners/command_line.hpp"

namespace zerocount {

/// The results file that --output names, in a folder that exists: asked before any work is done.
/// @throws Failure: bad_input where it names no file, machine_failed where its folder is not there.
std::filesystem::path output_place(const Arguments& arguments);

/// Where results are not written over: files that a verb reads, and what is no regular file.
/// @throws Failure (bad_input) where an output is an input, or another output, or exists and is no regular
/// file.
void protect_from_outputs(const Arguments& arguments, const std::vector<std::filesystem::path>& inputs,
                          const std::vector<std::filesystem::path>& outputs);

}  // namespace zerocount
