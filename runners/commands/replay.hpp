#pragma once

#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/shard.hpp"

namespace zerocount {

/// What of a replayed trial is not as it was recorded, one line each: its inputs, every measure of every
/// move, its jerks.
///
/// Whole numbers must be equal. Real ones may differ by 1e-9 of their size, because another machine's
/// exponential may round its last digit differently.
/// @param inputs the study's input columns.
/// @param measures those that were recorded of the moves. @param version of the layout of their file.
std::vector<std::string> differences(const std::vector<InputColumn>& inputs, const TrialResult& recorded,
                                     const TrialResult& replayed,
                                     const std::vector<RecordField<MoveOutcome>>& measures = outcome_fields(),
                                     std::int64_t version = format_version);

}  // namespace zerocount
