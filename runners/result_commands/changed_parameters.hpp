#pragma once

#include <string>
#include <vector>

#include "analysis/machine/monitor/machine_monitor.hpp"
#include "analysis/machine/monitor/monitor_baseline.hpp"
#include "analysis/machine/monitor/move_log.hpp"
#include "analysis/machine/monitor/parameter_change.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/trials/effort.hpp"

namespace zerocount::result_commands {

/// Explains an alarm of the monitor: which parameter of the study changed in the machine of the log. The
/// study is simulated with each of causes_of() changed, on the same random numbers:
///
///     for each parameter, while the effort lasts
///       leave it out if its extreme changes leave 16 trials as they are
///       simulate 64 trials with each of its changes
///     explain_change() with these trials
///     for the 8 likeliest parameters that fit, and the 3 likeliest in any case
///       simulate 128 trials with five changes about its interval
///     explain_change() with these trials
///     repeat the last two steps for 4 and 2 parameters, with 512 trials at each of four changes
///
/// The number of trials therefore depends on the study alone, and not on the computer. If the effort ends
/// before, the answer is that of the previous stage, and ChangeExplanation::untried lists the parameters that
/// were not tried.
/// @param file results in one setting (a condition at an age)
/// @param moves which simulated moves of the file are the baseline
/// @param unchanged names of parameters that cannot have changed, from unchanged_names()
/// @throws trial::Interrupted if a stop is requested from outside
monitor::ChangeExplanation explain_alarm(const reading::AllTrialsFile& file, const monitor::ModelMoves& moves,
                                         const monitor::MachineMonitor& machine, const monitor::MoveLog& log,
                                         const std::vector<std::string>& unchanged,
                                         const trials::Effort& effort);

}  // namespace zerocount::result_commands
