#pragma once

#include "runners/commands/command.hpp"

namespace zerocount::identification_commands {

commands::Command experiment_command();
commands::Command identify_command();

}  // namespace zerocount::identification_commands
