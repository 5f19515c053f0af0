#pragma once

#include <string>

#include "analysis/document/answer.hpp"
#include "analysis/monitor/machine_monitor.hpp"
#include "analysis/monitor/parameter_change.hpp"

namespace zerocount::monitor {

/// What the answer of `monitor` is made of.
struct MonitorReading {
  const MachineMonitor& monitor;
  const Baseline& baseline;
  MonitorState state;
  std::string log{};                              ///< name of the file of the moves
  const ChangeExplanation* explanation{nullptr};  ///< of an alarm beside a simulated study; null: none
};

document::AnswerDescription<MonitorReading> monitor_answer();

/// regression for a machine that changed, success for one that did not, inconclusive.
ExitCode exit_code_of(MachineStatus status);

}  // namespace zerocount::monitor
