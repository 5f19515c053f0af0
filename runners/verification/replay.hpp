#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/reading/statistics_file.hpp"
#include "results/reading/study_file.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::verification {

/// When a recorded and a replayed real number are equal.
enum class Equality {
  rounded,  ///< within a relative 1e-9: exponentials may be rounded differently on another machine
  bits      ///< the same bits; any two NaN are equal
};

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

/// Differences between the sample records of a retained trial and those of its replay.
/// @param fields the recorded columns
std::vector<std::string> trace_differences(
    const std::vector<layout::RecordField<layout::TraceRecord>>& fields, const shards::TrialResult& recorded,
    const shards::TrialResult& replayed, Equality equality);

/// The same for a trial of a results file, against its record.
std::vector<std::string> differences_from_record(const reading::StudyFile& file,
                                                 const shards::TrialResult& replayed);

/// Of trials that follow one another, to those that a file keeps because they failed; a line each, with the
/// number of the trial. None of a file that keeps no trials.
std::vector<std::string> differences_from_failures(const reading::StatisticsFile& file,
                                                   std::span<const shards::TrialResult> replayed,
                                                   Equality equality = Equality::rounded);

}  // namespace zerocount::verification
