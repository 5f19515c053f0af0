#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/hash/sha256.hpp"
#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/point_sums.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/shards/concatenate.hpp"
#include "results/shards/shard.hpp"
#include "results/shards/study_tables.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/written_bytes.hpp"

namespace zerocount::shards {

struct MergeOptions {
  layout::Provenance provenance{layout::current_provenance()};
  /// Maps the rows stored in the shards to the rows of the file, if they differ. ShardInfo has the rows of
  /// the file.
  Renumbering renumber{};
  /// Measures of the moves; null: the measures of this program, with the study's bands
  const layout::MeasureTable* measures{nullptr};
  std::stop_token stop{};                 ///< A request to stop interrupts the merge.
  timeline::Timeline* timeline{nullptr};  ///< Receives the spans of what any thread does; may be null.
};

/// The files of `inputs`, sorted by rows; a directory stands for its shard_files(). Each file must be a
/// finished shard or part of `study` with a valid checksum trailer.
/// @throws Failure: bad_data for the first file that is not; bad_input if an input does not exist or is a
/// directory without shards.
std::vector<ShardInfo> merge_inputs(std::span<const std::filesystem::path> inputs, const study::Study& study);

/// The header of the first file of `inputs`. Its manifest and overrides define the study to merge.
layout::FileHeader first_header(std::span<const std::filesystem::path> inputs);

/// The results file with the trials `rows` of a study, all or a part, which is made of shards.
///
///     MergedFile file(shards, study, output, rows);   joins their tables
///     file.write_sums(…)                              if the study does not keep every trial
///     file.write_statistics(…)                        of all points, if it is the whole study
///     file.finish();                                  the file appears
///
/// The shards, as returned by list_shards or merge_inputs, must cover `rows` exactly. Memory does not grow
/// with the number of shards. The bytes of every dataset depend only on the study and `rows`. `output`
/// appears when it is complete on the disk, and replaces an existing file. Its git_commit is the commit of
/// options.provenance, or of a shard whose build had uncommitted changes.
class MergedFile {
 public:
  /// @param study must live as long as this.
  /// @throws Failure: bad_data for gaps, overlaps and damaged shards; machine_failed with the path and the
  /// reason if the file cannot be written; interrupted if options.stop was requested. The other functions
  /// throw the same.
  MergedFile(std::span<const ShardInfo> shards, const study::Study& study, std::filesystem::path output,
             layout::RowRange rows, const MergeOptions& options = {});

  const std::vector<ShardInfo>& shards() const { return shards_; }  ///< Shards in order of rows
  bool is_whole() const { return rows_ == layout::all_rows(study_); }
  /// The trials, for a file that keeps every trial. They can be read although the file is unfinished.
  const reading::AllTrialsFile& trials();

  /// Writes the sums of all points.
  /// @param sums [point], counted from the point of the first trial.
  void write_sums(std::span<const layout::PointSums> sums);
  /// Writes the statistics of the next points, after those written before.
  void write_statistics(const layout::StoredStatistics& statistics);
  hdf5::File& file() { return file_; }  ///< The open file, for further groups

  /// Requires that the trials are in the file as they were written, to explain why they cannot be read.
  /// @throws Failure (machine_failed) otherwise.
  void require_trials() const { written_.hashed().require_in(part_.path(), timeline_); }
  void finish();
  /// The steps of finish(): close(), read_back(), publish().
  void close();
  /// Compares the file with what was written, and takes its checksum.
  void read_back();
  void publish() const;

 private:
  const study::Study& study_;
  std::filesystem::path output_;
  layout::RowRange rows_;
  const layout::MeasureTable* measures_;
  timeline::Timeline* timeline_;
  std::vector<ShardInfo> shards_;
  storage::UnfinishedFile part_;
  storage::WrittenBytes written_;
  hash::Sha256 checksum_{};  ///< Checksum of the bytes read back
  hdf5::File file_;
  std::optional<reading::AllTrialsFile> trials_;
  std::int64_t described_{0};  ///< Number of points with statistics
};

}  // namespace zerocount::shards
