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

/// Option --timeline, which writes the times of all stages and threads to a file, of commands that work on
/// all cores.
namespace zerocount::commands {

command_line::OptionSpec timeline_option();

/// Path of the timeline file (times of all stages and threads) that the option --timeline names; nothing
/// without the option. An existing timeline is replaced, because the same command, given again after an
/// interruption, writes it anew.
/// @throws Failure (bad_input) if the file exists and is not a timeline, and --force is not given
std::optional<std::filesystem::path> timeline_place(const command_line::Arguments& arguments);

/// Calls `work` with a timeline that records its stages, and writes the timeline to `place`, even if the work
/// fails or is interrupted.
/// @param place path of the timeline; nothing: `work` gets a null pointer
void with_timeline(const std::optional<std::filesystem::path>& place,
                   const std::function<void(timeline::Timeline* timeline)>& work);

/// Calls `work`, records the times of its parallel loops (parallel::Recording), and writes them as a timeline
/// to `place`.
/// @param place path of the timeline; nothing: none is written
/// @param name name of the recording, a string literal
ExitCode recorded(const std::optional<std::filesystem::path>& place, std::string_view name,
                  const std::function<ExitCode()>& work);

}  // namespace zerocount::commands
