#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/monitor/move_log.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/command_line/command_line.hpp"

/// What the verbs on machines in use have in common: logs of moves, and the simulated moves beside them.
namespace zerocount::result_commands {

/// Reads all of a log.
monitor::MoveLog read_log(const std::filesystem::path& path);

/// The trials under the condition of --condition, which a study with conditions needs.
reading::AllTrialsFile with_condition(const command_line::Arguments& arguments, reading::AllTrialsFile file);

/// The point of --point, which a study with several points needs.
std::int64_t point_of(const command_line::Arguments& arguments, const std::vector<std::string>& labels);

}  // namespace zerocount::result_commands
