#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "experiments/study/study_fwd.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/trial_tables.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::study_run {

/// File name extension of damaged shards, which are kept.
inline constexpr const char* damaged_extension = ".damaged";

/// The shards of earlier runs.
struct EarlierShards {
  std::vector<shards::ShardInfo> usable;   ///< in order of rows, without overlaps
  std::vector<std::filesystem::path> all;  ///< all valid shards of the study
};

/// Selects shards within `wanted` that do not overlap. Shards of runs with other parts may extend beyond it
/// or overlap; trials of unused shards are run again.
EarlierShards choose_shards(const std::vector<shards::ShardInfo>& sound, layout::RowRange wanted);

/// Treatment of shards of another study.
enum class ForeignShards { refuse, remove };

/// Finds the shards of earlier runs, whose checksums prove their values. Damaged shards are renamed and their
/// trials run again.
/// @throws Failure (bad_input) if the folder has shards of another study and `refuse` is given.
EarlierShards earlier_shards(const std::filesystem::path& directory, const study::Study& study,
                             layout::RowRange wanted, ForeignShards foreign = ForeignShards::refuse);

/// Removes the shards, and their folder if it is then empty.
void remove_shards(const std::filesystem::path& directory, const std::vector<std::filesystem::path>& shards);

/// Positions of the retained trials' records in a file, by global row.
using RecordPlaces = std::map<std::int64_t, layout::RowRange>;

RecordPlaces places_of_records(const reading::TrialTables& trials);

/// Reads the kept trials among `rows` with everything that is stored of them.
/// @param first_row  row of the results that corresponds to rows.first, in the study that they are for
/// @throws Failure as TrialTables
std::vector<shards::TrialResult> read_trials(const reading::TrialTables& trials, layout::RowRange rows,
                                             std::int64_t first_row, const RecordPlaces& records);

}  // namespace zerocount::study_run
