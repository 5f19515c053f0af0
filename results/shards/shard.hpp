#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/trial/outcome.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study.hpp"
#include "results/hdf5/element.hpp"
#include "results/layout/build_info.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/row_range.hpp"

namespace zerocount {

/// What is kept of one trial.
struct TrialResult {
  std::int64_t row{0};              ///< global row: point·trials + index
  std::vector<double> inputs;       ///< [input column of the study], in that column's unit
  TrialOutcome outcome;             ///< one entry per move
  std::vector<Jerk> jerks;          ///< by move and onset
  std::vector<SampleRecord> trace;  ///< every sample of a retained trial; otherwise empty
};

/// Where in `directory` the shard of these rows belongs.
std::filesystem::path shard_path(const std::filesystem::path& directory, RowRange rows);

/// Shards are read once more and gone.
inline constexpr Compression shard_compression = Compression::none;

/// Writes the results of the rows first_row, first_row + 1, … as one shard at `path`. The shard gets its name
/// only when it is whole on the disk.
/// @throws Failure (machine_failed) with the path and the reason; std::invalid_argument where the results
/// are not those rows in order, or do not fit the study.
void write_shard(const std::filesystem::path& path, const Study& study, std::int64_t first_row,
                 std::span<const TrialResult> results, const Provenance& provenance = current_provenance(),
                 Compression compression = shard_compression, const MeasureTable& measures = measure_table());

/// A shard (or a part of a study) that is whole and of the study.
struct ShardInfo {
  std::filesystem::path path;
  RowRange rows;
};

/// A file that cannot be used, and why.
struct ShardProblem {
  enum class Kind {
    damaged,  ///< its trials are lost
    foreign   ///< sound, but of another study, by another build, or of another or newer format (ForeignFile)
  };

  std::filesystem::path path;
  std::string problem;  ///< complete message, the path included
  Kind kind{Kind::damaged};
};

/// What stands in a folder of shards.
struct ShardSurvey {
  std::vector<ShardInfo> shards;                  ///< valid, in order of rows
  std::vector<ShardProblem> problems;             ///< damaged or foreign, in order of paths
  std::vector<std::filesystem::path> unfinished;  ///< *.part, left by a process that died; safe to remove
};

/// The files in `directory` that are shards by their names: regular files *.h5, in order of names.
/// @throws Failure (machine_failed) where the directory cannot be read.
std::vector<std::filesystem::path> shard_files(const std::filesystem::path& directory);

/// Reads the shard whole, and checks seal, format, version, study, build and completion mark.
/// @throws ForeignFile or another Failure (bad_data) where it cannot be used; see also open_results.
ShardInfo inspect_shard(const std::filesystem::path& path, const Study& study);

/// Inspects shard_files(directory); a directory that does not exist has none. Other files are left alone.
/// @throws Failure (machine_failed) where the directory or a file cannot be read: that is no damage.
ShardSurvey list_shards(const std::filesystem::path& directory, const Study& study);

/// The parts of `wanted` that no shard covers, in order. Shards may overlap.
std::vector<RowRange> missing_ranges(std::span<const ShardInfo> shards, RowRange wanted);

/// Removes files left by processes that died.
void remove_unfinished(const ShardSurvey& survey);

}  // namespace zerocount
