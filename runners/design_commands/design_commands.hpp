#pragma once

#include "runners/commands/command.hpp"

namespace zerocount::design_commands {

commands::Command plan_command();
commands::Command tune_command();
commands::Command limits_command();
commands::Command worst_command();
commands::Command rare_command();

}  // namespace zerocount::design_commands
