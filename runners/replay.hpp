#pragma once

#include <string>
#include <vector>

#include "core/trial/outcome.hpp"

namespace zerocount {

/// What of a replayed trial is not as it was recorded: one line per measure, "move M: NAME: recorded A,
/// replayed B".
///
/// Whole numbers must be equal. Real ones may differ by 1e-9 of their size, because another machine's
/// exponential may round its last digit differently.
std::vector<std::string> differences(const std::vector<MoveOutcome>& recorded,
                                     const std::vector<MoveOutcome>& replayed);

}  // namespace zerocount
