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
  /// Maps the global rows of trials in the shards to their rows in the merged file, if they differ. The rows
  /// in ShardInfo are those of the merged file.
  Renumbering renumber{};
  /// Measures of the moves that the file has; null: the measures of this program, with the study's error
  /// bands
  const layout::MeasureTable* measures{nullptr};
  std::stop_token stop{};                 ///< A request to stop ends the merge by a Failure (interrupted)
  timeline::Timeline* timeline{nullptr};  ///< Records which thread works at what time; null: no record
};

/// The shards or parts in `inputs`, sorted by rows; a directory stands for its shard_files(). Each file must
/// be a finished shard or part of `study` with a valid checksum trailer.
/// @throws Failure: bad_data for the first file that is not; bad_input if an input does not exist or is a
/// directory without shards.
std::vector<ShardInfo> merge_inputs(std::span<const std::filesystem::path> inputs, const study::Study& study);

/// The header of the first file of `inputs`. Its manifest (the study's input file) and overrides define the
/// study to merge.
layout::FileHeader first_header(std::span<const std::filesystem::path> inputs);

/// A results file that is made by joining shards (files with finished trials). It gets the trials `rows` of a
/// study, which are all trials or a part.
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
  /// Creates the file and writes the trials of all shards to it.
  /// @param study must live as long as this object.
  /// @throws Failure: bad_data for gaps, overlaps and damaged shards; machine_failed with the path and the
  /// reason if the file cannot be written; interrupted if options.stop was requested. The other functions
  /// throw the same.
  MergedFile(std::span<const ShardInfo> shards, const study::Study& study, std::filesystem::path output,
             layout::RowRange rows, const MergeOptions& options = {});

  /// The shards that were joined, in order of rows
  const std::vector<ShardInfo>& shards() const { return shards_; }
  bool is_whole() const { return rows_ == layout::all_rows(study_); }
  /// The trials in the merged file, if it keeps every trial. They can be read although the file is
  /// unfinished.
  const reading::AllTrialsFile& trials();

  /// Writes the sums over the trials of each design point.
  /// @param sums [point], counted from the point of the first trial.
  void write_sums(std::span<const layout::PointSums> sums);
  /// Writes the statistics of the next design points, after those written by earlier calls.
  void write_statistics(const layout::StoredStatistics& statistics);
  hdf5::File& file() { return file_; }  ///< The merged file while it is open, to write further groups to it

  /// Checks that the trials are in the file as they were written, to explain why they cannot be read.
  /// @throws Failure (machine_failed) if they are not.
  void require_trials() const { written_.hashed().require_in(part_.path(), timeline_); }
  void finish();
  /// Closes the file and flushes it to the disk. First of the steps of finish(): close(), read_back(),
  /// publish().
  void close();
  /// Reads the closed file back, compares it with what was written, and computes its checksum.
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
  hash::Sha256 checksum_{};  ///< SHA-256 of the bytes that read_back() has read
  hdf5::File file_;
  std::optional<reading::AllTrialsFile> trials_;
  std::int64_t described_{0};  ///< Number of design points whose statistics have been written
};

}  // namespace zerocount::shards
