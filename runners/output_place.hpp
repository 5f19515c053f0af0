#pragma once

#include <filesystem>

#include "runners/command_line.hpp"

namespace zerocount {

/// The results file that --output names, in a folder that exists: asked before any work is done.
/// @throws Failure: bad_input where it names no file, machine_failed where its folder is not there.
std::filesystem::path output_place(const Arguments& arguments);

}  // namespace zerocount
