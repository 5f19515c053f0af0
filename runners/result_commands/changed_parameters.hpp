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
/// study is simulated with each parameter of plant and friction between half and twice its value, with the
/// same random numbers: first with few trials and every second change, then with all those that are not
/// hopeless.
/// @param file under one condition at one age @param moves of its baseline
/// @param unchanged of unchanged_names()
/// @throws trial::Interrupted if a stop is requested
monitor::ChangeExplanation explain_alarm(const reading::AllTrialsFile& file, const monitor::ModelMoves& moves,
                                         const monitor::MachineMonitor& machine, const monitor::MoveLog& log,
                                         const std::vector<std::string>& unchanged,
                                         const trials::Effort& effort);

/// The names in comma-separated lists of parameters that cannot have changed: dotted paths, from which parts
/// in the middle or at the end may be left out, such as `controller.kp`, `encoder.noise` or `controller`.
/// @throws Failure (bad_input) if a name is not one of a parameter that is tried
std::vector<std::string> unchanged_names(const std::vector<std::string>& lists);

}  // namespace zerocount::result_commands
