#pragma once

#include "analysis/document/answer.hpp"
#include "analysis/summary/chosen_point.hpp"

namespace zerocount::result_commands {

/// The answer of `learn` on a point of a study.
/// @param name of the file, for messages
/// @throws Failure (bad_input) if nothing differs between worlds, or no move is judged
document::Answer learned_of(const std::string& name, const summary::StudySummary& summary,
                            const summary::ChosenPoint& chosen);

}  // namespace zerocount::result_commands
