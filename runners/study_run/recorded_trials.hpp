#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "results/layout/row_range.hpp"
#include "results/reading/trial_tables.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::study_run {

/// Positions of the retained trials' records in a file, by global row.
using RecordPlaces = std::map<std::int64_t, layout::RowRange>;

RecordPlaces places_of_records(const reading::TrialTables& trials);

/// Reads the kept trials among `rows` with everything that is stored of them.
/// @param first_row  row of the results that corresponds to rows.first, in the study that they are for
/// @throws Failure as TrialTables
std::vector<shards::TrialResult> read_trials(const reading::TrialTables& trials, layout::RowRange rows,
                                             std::int64_t first_row, const RecordPlaces& records);

}  // namespace zerocount::study_run
