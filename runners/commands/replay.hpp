#pragma once

#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/reading/study_file.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::commands {

/// Differences between a replayed trial and its record, one line each: inputs, measures of all moves, jerks.
///
/// Whole numbers must be equal. Real numbers may differ by a relative 1e-9, because exponentials may be
/// rounded differently on another machine.
/// @param inputs the study's input columns
/// @param measures the recorded measures of the moves @param version layout version of their file
std::vector<std::string> differences(
    const std::vector<study::InputColumn>& inputs, const shards::TrialResult& recorded,
    const shards::TrialResult& replayed,
    const std::vector<layout::RecordField<trial::MoveOutcome>>& measures = layout::outcome_fields(),
    std::int64_t version = layout::format_version);

/// The same for a trial of a results file, against its record.
std::vector<std::string> differences_from_record(const reading::StudyFile& file,
                                                 const shards::TrialResult& replayed);

}  // namespace zerocount::commands
