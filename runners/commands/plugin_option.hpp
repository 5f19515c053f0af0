#pragma once

#include <memory>

#include "core/plugin/controller_plugin.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::commands {

/// The user's controller for the trials of a results file, of the option --plugin; null if none is given.
std::shared_ptr<const plugin::ControllerPlugin> plugin_option(const command_line::Arguments& arguments);

}  // namespace zerocount::commands
