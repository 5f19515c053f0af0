#pragma once

#include <vector>

#include "analysis/document/figure.hpp"
#include "runners/design_commands/tune_answer.hpp"

namespace zerocount::design_commands {

/// The maps, the frontier, room and limits, and the worst machine of the proof; none without a proof.
std::vector<document::Figure> tune_figures(const Tuning& tuning);

}  // namespace zerocount::design_commands
