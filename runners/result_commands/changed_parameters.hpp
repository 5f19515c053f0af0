#pragma once

#include "analysis/monitor/machine_monitor.hpp"
#include "analysis/monitor/monitor_baseline.hpp"
#include "analysis/monitor/move_log.hpp"
#include "analysis/monitor/parameter_change.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/trials/effort.hpp"

namespace zerocount::result_commands {

/// Tells which parameter of the study changed in the machine of the log, after an alarm of the monitor. The
/// study is simulated with each parameter of plant and friction between half and twice its value, with the
/// same random numbers.
/// @param file under one condition at one age @param moves of its baseline
/// @throws trial::Interrupted if a stop is requested
monitor::ChangeExplanation explain_alarm(const reading::AllTrialsFile& file, const monitor::ModelMoves& moves,
                                         const monitor::MachineMonitor& machine, const monitor::MoveLog& log,
                                         const trials::Effort& effort);

}  // namespace zerocount::result_commands
