#pragma once

#include "runners/commands/command.hpp"

namespace zerocount::result_commands {

commands::Command history_command();
commands::Command report_command();
commands::Command plot_command();
commands::Command sensitivity_command();
commands::Command jerks_command();
commands::Command compare_command();
commands::Command learn_command();
commands::Command monitor_command();
commands::Command accept_command();
commands::Command baseline_command();
commands::Command summary_command();
commands::Command judge_command();

}  // namespace zerocount::result_commands
