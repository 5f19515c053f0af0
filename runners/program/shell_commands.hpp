#pragma once

#include "runners/commands/command.hpp"

namespace zerocount::program {

commands::Command completion_command();
commands::Command manual_command();
commands::Command schema_command();

}  // namespace zerocount::program
