#pragma once

#include <memory>

#include "core/plugin/controller_plugin.hpp"
#include "runners/controller_code/program.hpp"

namespace zerocount::controller_code {

/// The program as a control law of this process, statement by statement in its precision.
std::shared_ptr<const plugin::ControllerPlugin> law_of(const Program& program);

}  // namespace zerocount::controller_code
