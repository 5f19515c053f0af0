#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "core/plugin/controller_plugin.hpp"
#include "experiments/study/study_fwd.hpp"
#include "results/reading/results_file.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::commands {

/// Whether `path` is a results file, by its signature or by its name (the signature may be damaged).
bool is_results_file(const std::filesystem::path& path);

/// @throws Failure (bad_input) if the trials of the file's study cannot be run: its controller is a plugin
void require_simulable(const reading::ResultsFile& file);

/// The study of a finished results file, by its description: none of its trials is read, nor its checksum.
/// @throws Failure as layout::recorded_study and shards::inspect_header
study::Study described_study(const std::filesystem::path& path);

/// The study of `MANIFEST|FILE`: that of a manifest, with the overrides of `--set`, or the one whose trials a
/// complete results file holds. The files that a manifest names are found from its folder, or from the
/// current one if it is a stream.
/// @throws Failure: bad_input with every error of the manifest, or if a file that it names is an output of
/// the command, even with --force; of a results file with --set or with a plugin, which the file does not
/// contain; otherwise as reading::ResultsFile
study::Study load_study(const std::filesystem::path& operand, const command_line::Arguments& arguments);

/// `--point` of `MANIFEST|FILE`: a point by label or number, or `best`, which is summary::best_point() of a
/// results file and the only point of a manifest; nothing without the option.
/// @throws Failure: bad_input for `best` of a manifest with several points; as summary::summarise_file
std::optional<std::int64_t> study_point(const command_line::Arguments& arguments, const study::Study& study);

/// The user's controller for the trials of a results file, of the option --plugin; null if none is given.
std::shared_ptr<const plugin::ControllerPlugin> plugin_option(const command_line::Arguments& arguments);

}  // namespace zerocount::commands
