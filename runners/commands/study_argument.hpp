#pragma once

#include <filesystem>

#include "experiments/study/study.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::commands {

/// The study of a manifest with the overrides of `--set`. The files that it names are found from its folder.
/// @throws Failure (bad_input) with every error of the manifest
study::Study load_study(const std::filesystem::path& manifest, const command_line::Arguments& arguments);

}  // namespace zerocount::commands
