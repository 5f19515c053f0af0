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

/// The option --timeline of commands that work on all cores.
namespace zerocount::commands {

command_line::OptionSpec timeline_option();

/// The file of --timeline. A timeline that exists is replaced: the same command, given again after an
/// interruption, writes it anew.
/// @throws Failure (bad_input) if it exists and is no timeline and --force is not given
std::optional<std::filesystem::path> timeline_place(const command_line::Arguments& arguments);

/// Calls `work`, and writes what it did to `place`, also of work that fails or is interrupted.
/// @param place none: `work` gets no timeline
void with_timeline(const std::optional<std::filesystem::path>& place,
                   const std::function<void(timeline::Timeline* timeline)>& work);

/// The same of work whose loops over indices are recorded (parallel::Recording). @param name a literal
ExitCode recorded(const std::optional<std::filesystem::path>& place, std::string_view name,
                  const std::function<ExitCode()>& work);

}  // namespace zerocount::commands
