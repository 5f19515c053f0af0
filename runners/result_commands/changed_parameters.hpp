#pragma once

#include <string>
#include <vector>

#include "analysis/monitor/machine_monitor.hpp"
#include "analysis/monitor/monitor_baseline.hpp"
#include "analysis/monitor/move_log.hpp"
#include "analysis/monitor/parameter_change.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/trials/effort.hpp"

namespace zerocount::result_commands {

/// Tells which parameter of the study changed in the machine of the log, after an alarm of the monitor. The
/// study is simulated with each of causes_of() changed, with the same random numbers:
///
///     for each parameter, while the effort lasts
///       leave it out if its extreme changes leave 16 trials as they are
///       simulate 64 trials with each of its changes
///     explain_change() by these
///     for the 8 likeliest parameters that fit, and the 3 likeliest in any case
///       simulate 128 trials with five changes about its interval
///     explain_change() by these
///     the same once more: for 4 and 2 parameters, 512 trials with each of four changes
///
/// So the answer takes a number of trials that depends on the study alone, and not on the computer. Where the
/// effort ends before, it is that of the stage before, and ChangeExplanation::untried has the parameters that
/// were not tried.
/// @param file under one condition at one age @param moves of its baseline
/// @param unchanged of unchanged_names()
/// @throws trial::Interrupted if a stop is requested from outside
monitor::ChangeExplanation explain_alarm(const reading::AllTrialsFile& file, const monitor::ModelMoves& moves,
                                         const monitor::MachineMonitor& machine, const monitor::MoveLog& log,
                                         const std::vector<std::string>& unchanged,
                                         const trials::Effort& effort);

}  // namespace zerocount::result_commands
