#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/build_info.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/study_file.hpp"
#include "results/shards/concatenate.hpp"
#include "results/shards/shard.hpp"

namespace zerocount {

/// Computes the statistics of the design points from a file that holds all its trials but is not finished.
using StatisticsOfPoints = std::function<StoredStatistics(const StudyFile&)>;

/// The files that `inputs` name: files stand for themselves, directories for their shard_files. In order of
/// rows. Each is read whole, for its seal, and must be a finished shard or part of `study`.
/// @throws Failure (bad_data) for the first that is not; bad_input where an input does not exist, or is a
/// directory without shards.
std::vector<ShardInfo> merge_inputs(std::span<const std::filesystem::path> inputs, const Study& study);

/// The header of the first file that `inputs` name: its manifest and overrides give the study to merge.
FileHeader first_header(std::span<const std::filesystem::path> inputs);

/// Joins shards into the results file `output`, which holds the trials `rows` of the study: the whole study,
/// or a part.
///
/// The shards, found sound by list_shards or merge_inputs, must cover `rows` exactly. Memory is bounded
/// whatever their number; the bytes of every dataset depend on the study and `rows` alone. `statistics` is
/// called once, where the file is the whole study. The file gets its name only when it is whole on the disk;
/// what had it before is replaced.
/// Its git_commit is that of `provenance`, or of a shard whose build had changes that were not committed.
/// `renumber` is for shards that were written under other rows: the rows in ShardInfo are those of the file,
/// and it turns the rows that stand in the shards into those.
/// @throws Failure: bad_data for gaps, overlaps and damaged shards; machine_failed with the path and the
/// reason where it cannot be written.
void merge_shards(std::span<const ShardInfo> shards, const Study& study, const std::filesystem::path& output,
                  RowRange rows, const StatisticsOfPoints& statistics,
                  const Provenance& provenance = current_provenance(), const Renumbering& renumber = {},
                  const MeasureTable& measures = measure_table());

}  // namespace zerocount
