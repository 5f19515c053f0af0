#pragma once

#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::verification {

/// When a recorded and a replayed real number are equal.
enum class Equality {
  rounded,  ///< within a relative 1e-9: exponentials may be rounded differently on another machine
  bits      ///< the same bits; any two NaN are equal
};

/// To the bit if this program on this machine made the file.
Equality equality_of(const layout::FileHeader& header);

/// Differences between a replayed trial and its record, one line each: inputs, measures of all moves, jerks.
/// Whole numbers must be equal.
/// @param inputs the study's input columns
/// @param measures the recorded measures of the moves @param version layout version of their file
/// @param equality of real numbers
std::vector<std::string> differences(
    const std::vector<study::InputColumn>& inputs, const shards::TrialResult& recorded,
    const shards::TrialResult& replayed,
    const std::vector<layout::RecordField<trial::MoveOutcome>>& measures = layout::outcome_fields(),
    std::int64_t version = layout::format_version, Equality equality = Equality::rounded);

/// Differences between a replayed trial of a results file and its record, including the sample records if the
/// record has them.
/// @param recorded null if the file does not keep the trial: then it keeps failures, and the replay must
/// succeed
std::vector<std::string> differences_from_record(const reading::ResultsFile& file,
                                                 const shards::TrialResult* recorded,
                                                 const shards::TrialResult& replayed, Equality equality);

/// Reads the record from the file; sample records are not compared. No differences if the file keeps no
/// trials.
std::vector<std::string> differences_from_record(const reading::ResultsFile& file,
                                                 const shards::TrialResult& replayed, Equality equality);

}  // namespace zerocount::verification
