#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/point_sums.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/study_file.hpp"
#include "results/shards/concatenate.hpp"
#include "results/shards/rig_tables.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::shards {

/// Computes the statistics of the design points from a file that holds all trials but is not finished.
using StatisticsOfPoints = std::function<layout::StoredStatistics(const reading::StudyFile&)>;

/// The sums of consecutive trials, and the statistics computed from them.
struct SummedTrials {
  std::vector<layout::PointSums> sums;  ///< [point, from that of the first trial]
  layout::StoredStatistics statistics;  ///< of all trials of the study; otherwise empty
};

/// Adds the sums of shards, which are in order of rows.
using SumsOfTrials = std::function<SummedTrials(std::span<const ShardInfo>)>;

struct MergeOptions {
  layout::Provenance provenance{layout::current_provenance()};
  /// For shards whose rows differ from those of the file: ShardInfo has the rows of the file, and this maps
  /// the rows stored in the shards to them.
  Renumbering renumber{};
  const layout::MeasureTable* measures{nullptr};  ///< null: those of this program, with the study's bands
  SumsOfTrials sums_of{};                         ///< needed if the study does not keep every trial
  std::stop_token stop{};                         ///< interrupts the merge
};

/// The files of `inputs`, sorted by rows; a directory stands for its shard_files(). Each file must be a
/// finished shard or part of `study` with a valid checksum trailer.
/// @throws Failure: bad_data for the first file that is not; bad_input if an input does not exist or is a
/// directory without shards.
std::vector<ShardInfo> merge_inputs(std::span<const std::filesystem::path> inputs, const study::Study& study);

/// The header of the first file of `inputs`. Its manifest and overrides define the study to merge.
layout::FileHeader first_header(std::span<const std::filesystem::path> inputs);

/// Joins shards into the results file `output` with the trials `rows` of the study: all of them, or a part.
///
/// The shards, as returned by list_shards or merge_inputs, must cover `rows` exactly. Memory does not grow
/// with their number. The bytes of every dataset depend only on the study and `rows`. `output` appears when
/// it is complete on the disk, and replaces an existing file. Its git_commit is that of options.provenance,
/// or that of a shard whose build had uncommitted changes.
/// @param statistics called once if the file holds every trial of the whole study
/// @throws Failure: bad_data for gaps, overlaps and damaged shards; machine_failed with the path and the
/// reason if the file cannot be written; interrupted if options.stop was requested.
void merge_shards(std::span<const ShardInfo> shards, const study::Study& study,
                  const std::filesystem::path& output, layout::RowRange rows,
                  const StatisticsOfPoints& statistics, const MergeOptions& options = {});

}  // namespace zerocount::shards
