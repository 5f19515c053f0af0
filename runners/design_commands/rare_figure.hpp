#pragma once

#include <vector>

#include "analysis/document/figure.hpp"
#include "runners/rare/failure_description.hpp"

namespace zerocount::design_commands {

/// The ranges of the inputs in failures beside those in all trials; none without inputs that vary.
std::vector<document::Figure> rare_figures(const std::vector<rare::FailureInput>& inputs);

}  // namespace zerocount::design_commands
