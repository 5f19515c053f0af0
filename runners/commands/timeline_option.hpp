#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>

#include "core/failure/failure.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::timeline {
class Timeline;
}

/// Option --timeline of commands that work on all cores.
namespace zerocount::commands {

command_line::OptionSpec timeline_option();

/// Path of the option --timeline; nothing without the option. An existing timeline is replaced, because the
/// same command, given again after an interruption, writes it anew.
/// @throws Failure (bad_input) if the file exists and is not a timeline, and --force is not given
std::optional<std::filesystem::path> timeline_place(const command_line::Arguments& arguments);

/// Calls `work` and writes its timeline to `place`, even if it fails or is interrupted.
/// @param place path of the timeline; nothing: `work` gets no timeline
void with_timeline(const std::optional<std::filesystem::path>& place,
                   const std::function<void(timeline::Timeline* timeline)>& work);

/// Calls `work`, records its loops over indices (parallel::Recording), and writes the timeline to `place`.
/// @param name name of the recording, a string literal
ExitCode recorded(const std::optional<std::filesystem::path>& place, std::string_view name,
                  const std::function<ExitCode()>& work);

}  // namespace zerocount::commands
