#pragma once

#include <string>
#include <vector>

#include "runners/controller_code/chain_program.hpp"

namespace zerocount::controller_code {

/// Lines of the comment at the top of a written controller.
std::vector<std::string> heading_lines(const ControllerToWrite& chain, Precision precision);

}  // namespace zerocount::controller_code
