#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/monitor/move_log.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/command_line/command_line.hpp"

/// What the verbs on machines in use have in common: logs of moves, and the simulated moves beside them.
namespace zerocount::result_commands {

/// Reads all of a log. @param group column of the groups of moves; empty: none
monitor::MoveLog read_log(const std::filesystem::path& path, const std::string& group = {});

/// Refuses what read_log() does not open, such as a directory.
void require_log(const std::filesystem::path& path);
/// Refuses a log of more bytes than read_log() reads.
void require_log_size(const std::filesystem::path& path, std::size_t size);

/// The trials under the condition of --condition at the age of --age, which a study with several needs.
reading::AllTrialsFile with_condition(const command_line::Arguments& arguments, reading::AllTrialsFile file);

/// The point of --point, which a study with several points needs.
std::int64_t point_of(const command_line::Arguments& arguments, const std::vector<std::string>& labels);

}  // namespace zerocount::result_commands
