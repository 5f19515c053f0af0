#pragma once

#include "runners/commands/command.hpp"

namespace zerocount::study_commands {

commands::Command new_command();
commands::Command status_command();
commands::Command run_command();
commands::Command verify_command();
commands::Command merge_command();
commands::Command parameters_command();
commands::Command trace_command();
commands::Command export_command();
commands::Command controller_command();
commands::Command check_command();

}  // namespace zerocount::study_commands
