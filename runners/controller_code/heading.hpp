#pragma once

#include <string>
#include <vector>

#include "runners/controller_code/chain_program.hpp"

namespace zerocount::controller_code {

/// What a reader of the written controller needs to know, line by line.
std::vector<std::string> heading_lines(const ControllerToWrite& chain, Precision precision);

}  // namespace zerocount::controller_code
