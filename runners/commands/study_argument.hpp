#pragma once

#include <filesystem>
#include <span>

#include "experiments/study/study.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::commands {

/// Whether `path` is a results file, by its signature or by its name (the signature may be damaged).
bool is_results_file(const std::filesystem::path& path);

/// The study of a finished results file, by its description: none of its trials is read, nor its checksum.
/// @throws Failure as layout::recorded_study and shards::inspect_header
study::Study described_study(const std::filesystem::path& path);

/// The study of a manifest with the overrides of `--set`. The files that it names are found from its folder,
/// or from the current one if the manifest is a stream.
/// @param outputs none of them may be the manifest or a file that it names, even with --force
/// @throws Failure (bad_input) with every error of the manifest
study::Study load_study(const std::filesystem::path& manifest, const command_line::Arguments& arguments,
                        std::span<const std::filesystem::path> outputs = {});

}  // namespace zerocount::commands
