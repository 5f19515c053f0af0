#include "results/shards/merge.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"
#include "results/shards/concatenate.hpp"
#include "results/shards/study_tables.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"

namespace zerocount::shards {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(ExitCode code, const fs::path& path, const std::string& problem) {
  throw Failure(code, fmt::format("{}: {}", path.string(), problem));
}

std::vector<fs::path> expand(std::span<const fs::path> inputs) {
  std::vector<fs::path> files;
  for (const fs::path& input : inputs) {
    std::error_code error;
    if (!fs::is_directory(input, error)) {
      files.push_back(input);
      continue;
    }
    const std::vector<fs::path> found = shard_files(input);
    if (found.empty())
      fail(ExitCode::bad_input, input, "no shards (*.shard) or parts (*.h5) in this directory");
    files.insert(files.end(), found.begin(), found.end());
  }
  if (files.empty())
    throw Failure(ExitCode::bad_input, "nothing to merge: name shards, parts or directories of shards");
  return files;
}

/// Checks that the shards, sorted by rows, cover `rows` without gaps and overlaps.
/// @throws Failure otherwise.
void require_cover(std::span<const ShardInfo> shards, layout::RowRange rows, const fs::path& output) {
  std::int64_t next = rows.first;
  const ShardInfo* previous = nullptr;
  for (const ShardInfo& shard : shards) {
    if (previous != nullptr && shard.path == previous->path)
      fail(ExitCode::bad_data, shard.path, "is given twice");
    if (previous != nullptr && shard.rows.first < next) {
      fail(ExitCode::bad_data, shard.path,
           fmt::format("holds trials {} to {}, which overlap those of {}", shard.rows.first,
                       shard.rows.end() - 1, previous->path.string()));
    }
    if (shard.rows.first < rows.first || shard.rows.end() > rows.end()) {
      fail(ExitCode::bad_data, shard.path,
           fmt::format("holds trials {} to {}, outside the {} to {} to be merged", shard.rows.first,
                       shard.rows.end() - 1, rows.first, rows.end() - 1));
    }
    if (shard.rows.first > next) {
      fail(
          ExitCode::bad_data, output,
          fmt::format("cannot merge: trials {} to {} are in none of the shards", next, shard.rows.first - 1));
    }
    next = shard.rows.end();
    previous = &shard;
  }
  if (next < rows.end()) {
    fail(ExitCode::bad_data, output,
         fmt::format("cannot merge: trials {} to {} are in none of the shards", next, rows.end() - 1));
  }
}

/// Provenance that the merged file records: `provenance`, but with the git commit of a shard that was made by
/// a build with uncommitted changes, if there is one.
layout::Provenance merged_provenance(std::span<const ShardInfo> shards, layout::Provenance provenance) {
  for (const ShardInfo& shard : shards) {
    if (layout::is_dirty(provenance)) break;
    const layout::FileHeader header = unchecked_header(shard.path);
    if (layout::is_dirty(header.provenance)) provenance.git_commit = header.provenance.git_commit;
  }
  return provenance;
}

void write_points(hdf5::File& file, const study::Study& study) {
  const std::int64_t points = study::point_count(study);
  layout::TableIo io = layout::TableIo::create(file, layout::point_table(study.points.axes, {}), points, 1);
  io.number_rows(0);
  io.column(0).write_texts(study.points.labels);
  for (std::size_t index = 0; index < study.points.axes.size(); ++index) {
    const study::SweepAxis& axis = study.points.axes[index];
    if (axis.kind == study::SweepAxis::Kind::text) {
      io.column(1 + index).write_texts(axis.texts);
    } else {
      io.column(1 + index).write(0, points, axis.numbers.data());
    }
  }
}

/// Creates the file `part` and writes the description of the study to it.
hdf5::File begin_file(const study::Study& study, const fs::path& part, layout::RowRange rows,
                      const layout::Provenance& provenance) {
  hdf5::File file = hdf5::File::create(part);
  layout::write_header(file, layout::make_header(study, layout::FileKind::study, rows, provenance));
  write_points(file, study);
  return file;
}

/// Writes the global rows of the kept trials, computed from design point and index, as the scale of the
/// trials, in a file that keeps only some trials of its study.
void number_kept_trials(hdf5::File& file, const study::Study& study) {
  layout::TableIo trials = layout::TableIo::open(file, layout::trial_table({}));
  layout::TableIo outcomes = layout::TableIo::open(file, layout::verdict_table());
  std::vector<std::int64_t> points, rows;
  for (std::int64_t first = 0; first < trials.rows(); first += layout::chunk_elements) {
    const std::int64_t count = std::min(layout::chunk_elements, trials.rows() - first);
    points.resize(static_cast<std::size_t>(count));
    rows.resize(points.size());
    trials.column(0).read(first, count, points.data());
    trials.column(1).read(first, count, rows.data());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] += points[i] * study.trials;
    trials.row_scale().write(first, count, rows.data());
    outcomes.row_scale().write(first, count, rows.data());
  }
}

/// Writes the merged file except sums, statistics and the completion mark.
/// @returns the record of the bytes written.
storage::WrittenBytes write_trials_of(std::span<const ShardInfo> shards, const study::Study& study,
                                      const fs::path& part, layout::RowRange rows,
                                      const MergeOptions& options) {
  hdf5::File file = begin_file(study, part, rows, merged_provenance(shards, options.provenance));
  const auto join = [&](const layout::Table& table, std::int64_t width,
                        std::optional<std::int64_t> first_number, const Renumbering& renumber = {}) {
    concatenate(file, table, shards, width, first_number, {renumber, options.stop, options.timeline});
  };
  const bool sparse = layout::has_sums(study.retention);
  if (layout::has_trials(study.retention)) {
    const layout::MeasureTable& measures =
        options.measures != nullptr ? *options.measures : layout::measure_table(study.features);
    const auto first_row = sparse ? std::nullopt : std::optional(rows.first);
    join(layout::trial_table(study.columns.inputs), 1, first_row);
    join(layout::on_axis(layout::outcome_table(study.features, measures), study.units.axis), study.moves,
         first_row);
    join(layout::on_axis(layout::band_table(study.features.bands), study.units.axis), study.moves,
         std::nullopt);
    if (study.features.tolerances.count > 0)
      join(layout::on_axis(layout::tolerance_table(study.features), study.units.axis), study.moves,
           std::nullopt);
    join(layout::jerk_table(), 1, 0, options.renumber);
    if (sparse) number_kept_trials(file, study);
  }
  write_profiles(file, study);
  for (const layout::Grouping& grouping : layout::groupings()) write_groups(file, study, grouping);
  if (!study.retained_trials.empty())
    join(layout::on_axis(layout::trace_table(study.features), study.units.axis), 1, 0, options.renumber);
  return file.close(storage::Flush::later);
}

void write_point_statistics(hdf5::File& file, const study::Study& study,
                            const layout::StoredStatistics& statistics, layout::RowRange points) {
  std::vector<layout::PointColumn> columns;
  for (const layout::PointColumn& column : statistics.points)
    columns.push_back(layout::on_axis(column, study.units.axis));
  layout::write_point_columns(file, layout::point_table(study.points.axes, {}), columns, study.features,
                              points);
}

/// The shards sorted by rows.
/// @throws Failure unless they cover `rows` without gaps and overlaps.
std::vector<ShardInfo> in_order(std::span<const ShardInfo> shards, layout::RowRange rows,
                                const fs::path& output) {
  std::vector<ShardInfo> ordered(shards.begin(), shards.end());
  sort_by_rows(ordered);
  require_cover(ordered, rows, output);
  return ordered;
}

}  // namespace

std::vector<ShardInfo> merge_inputs(std::span<const fs::path> inputs, const study::Study& study) {
  std::vector<ShardInfo> shards;
  for (const fs::path& path : expand(inputs)) shards.push_back(checked_shard(path, study));
  sort_by_rows(shards);
  return shards;
}

layout::FileHeader first_header(std::span<const fs::path> inputs) {
  return inspect_header(expand(inputs).front());
}

MergedFile::MergedFile(std::span<const ShardInfo> shards, const study::Study& study, fs::path output,
                       layout::RowRange rows, const MergeOptions& options)
    : study_(study),
      output_(std::move(output)),
      rows_(rows),
      measures_(options.measures),
      timeline_(options.timeline),
      shards_(in_order(shards, rows, output_)),
      part_(output_),
      written_(write_trials_of(shards_, study, part_.path(), rows, options)),
      file_(hdf5::File::open_to_change(part_.path(), written_)) {}

const reading::AllTrialsFile& MergedFile::trials() {
  if (!trials_) trials_.emplace(part_.path(), reading::Require::unfinished, measures_);
  return *trials_;
}

void MergedFile::write_sums(std::span<const layout::PointSums> sums) {
  layout::write_sums(file_, rows_.first / study_.trials, sums);
}

void MergedFile::write_statistics(const layout::StoredStatistics& statistics) {
  const auto columns =
      statistics.points.empty() ? study::point_count(study_) : std::ssize(statistics.points[0].values);
  const layout::RowRange points{described_, columns};
  described_ = points.end();
  write_point_statistics(file_, study_, statistics, points);
  for (layout::StatisticTable table : statistics.tables) {
    for (layout::PointColumn& column : table.columns)
      column = layout::on_axis(std::move(column), study_.units.axis);
    layout::write_statistic_table(file_, table, study::point_count(study_), points);
  }
  for (const layout::Grouping& grouping : layout::groupings()) {
    const auto counts = statistics.groups.find(grouping.name);
    if (counts != statistics.groups.end())
      write_group_counts(file_, study_, grouping, counts->second, points.first);
  }
}

void MergedFile::finish() {
  close();
  read_back();
  publish();
}

void MergedFile::close() {
  trials_.reset();
  layout::mark_finished(file_);
  written_ = file_.close();
}

void MergedFile::read_back() {
  checksum_ = written_.require_in(part_.path(), timeline_);
}

void MergedFile::publish() const {
  storage::publish_compared(output_, checksum_);
}

}  // namespace zerocount::shards
