#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "results/layout/row_range.hpp"
#include "results/reading/study_file.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::study_run {

/// Positions of the retained trials' records in a file, by global row.
using RecordPlaces = std::map<std::int64_t, layout::RowRange>;

RecordPlaces places_of_records(const reading::StudyFile& file);

/// Reads the trials `rows` of the file with all that is stored of them. They are numbered from `first_row`
/// on, their rows in the study that they are for.
/// @throws Failure as StudyFile
std::vector<shards::TrialResult> read_trials(const reading::StudyFile& file, layout::RowRange rows,
                                             std::int64_t first_row, const RecordPlaces& records);

}  // namespace zerocount::study_run
