#include "results/shards/merge.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"
#include "results/shards/concatenate.hpp"
#include "results/shards/rig_tables.hpp"
#include "results/storage/durable_file.hpp"

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
    if (found.empty()) fail(ExitCode::bad_input, input, "no shards (*.h5) in this directory");
    files.insert(files.end(), found.begin(), found.end());
  }
  if (files.empty())
    throw Failure(ExitCode::bad_input, "nothing to merge: name shards, parts or directories of shards");
  return files;
}

/// @throws Failure unless the shards, sorted by rows, cover `rows` without gaps and overlaps.
void require_cover(std::span<const ShardInfo> shards, layout::RowRange rows, const fs::path& output) {
  std::int64_t next = rows.first;
  const ShardInfo* previous = nullptr;
  for (const ShardInfo& shard : shards) {
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

/// `provenance` of the merged file. If a shard was made by a build with uncommitted changes, the file has the
/// commit of that shard.
layout::Provenance merged_provenance(std::span<const ShardInfo> shards, layout::Provenance provenance) {
  for (const ShardInfo& shard : shards) {
    if (layout::is_dirty(provenance)) break;
    const layout::FileHeader header = layout::read_header(hdf5::File::open_to_read(shard.path));
    if (layout::is_dirty(header.provenance)) provenance.git_commit = header.provenance.git_commit;
  }
  return provenance;
}

void write_points(hdf5::File& file, const study::Study& study) {
  const std::int64_t points = study::point_count(study);
  layout::TableIo io = layout::TableIo::create(file, layout::point_table(study.axes, {}), points, 1);
  io.number_rows(0);
  io.column(0).write_texts(study.point_labels);
  for (std::size_t index = 0; index < study.axes.size(); ++index) {
    const study::SweepAxis& axis = study.axes[index];
    if (axis.kind == study::SweepAxis::Kind::text) {
      io.column(1 + index).write_texts(axis.texts);
    } else {
      io.column(1 + index).write(0, points, axis.numbers.data());
    }
  }
}

/// Writes everything except the statistics and the completion mark.
hdf5::WrittenValues write_trials_of(std::span<const ShardInfo> shards, const study::Study& study,
                                    const fs::path& part, layout::RowRange rows,
                                    const layout::Provenance& provenance, const Renumbering& renumber,
                                    const layout::MeasureTable& measures) {
  hdf5::File file = hdf5::File::create(part);
  layout::write_header(file, layout::make_header(study, layout::FileKind::study, rows, provenance));
  write_points(file, study);
  concatenate(file, layout::trial_table(study.input_columns), shards, 1, rows.first);
  const parameters::AxisKind axis = study.units.axis;
  concatenate(file,
              layout::on_axis(layout::outcome_table(layout::format_version, study.features, measures), axis),
              shards, study.moves, rows.first);
  concatenate(file, layout::jerk_table(), shards, 1, 0, renumber);
  write_profiles(file, study);
  if (study.rigs > 0) write_rigs(file, study);
  if (!study.retained_trials.empty()) {
    concatenate(file, layout::on_axis(layout::trace_table(study.features), axis), shards, 1, 0, renumber);
  }
  return file.close();
}

layout::StoredStatistics statistics_of(const fs::path& part, const hdf5::WrittenValues& written,
                                       const StatisticsOfPoints& statistics,
                                       const layout::MeasureTable& measures) {
  try {
    return statistics(reading::StudyFile(part, reading::Require::unfinished, measures));
  } catch (const Failure&) {
    hdf5::require_written(part, written);  // if the write failed, report that instead
    throw;
  }
}

void write_point_statistics(hdf5::File& file, const study::Study& study,
                            const layout::StoredStatistics& statistics) {
  layout::TableIo io = layout::TableIo::open(file, layout::point_table(study.axes, {}));
  const parameters::AxisKind axis = study.units.axis;
  const layout::Table described = layout::on_axis(layout::point_table({}, statistics.points), axis);
  for (std::size_t index = 0; index < statistics.points.size(); ++index) {
    const layout::PointColumn& statistic = statistics.points[index];
    if (std::ssize(statistic.values) != io.rows()) {
      throw std::invalid_argument(
          fmt::format("the statistic '{}' needs one value per design point", statistic.name));
    }
    io.add(described.columns[1 + index]).write(0, io.rows(), statistic.values.data());
  }
}

/// @param written contents of the file so far; returned with the added values
hdf5::WrittenValues write_statistics(const fs::path& part, const study::Study& study, layout::RowRange rows,
                                     hdf5::WrittenValues written,
                                     const layout::StoredStatistics& statistics) {
  hdf5::File file = hdf5::File::open_to_change(part, std::move(written));
  write_point_statistics(file, study, statistics);
  for (layout::StatisticTable table : statistics.tables) {
    for (layout::PointColumn& column : table.columns)
      column = layout::on_axis(std::move(column), study.units.axis);
    layout::write_statistic_table(file, table, study::point_count(study));
  }
  if (statistics.groups) statistics.groups(file);
  if (study.rigs > 0 && rows == layout::all_rows(study)) write_rig_counts(file, study);
  layout::mark_finished(file);
  return file.close();
}

}  // namespace

std::vector<ShardInfo> merge_inputs(std::span<const fs::path> inputs, const study::Study& study) {
  std::vector<ShardInfo> shards;
  for (const fs::path& path : expand(inputs)) shards.push_back(inspect_shard(path, study));
  sort_by_rows(shards);
  return shards;
}

layout::FileHeader first_header(std::span<const fs::path> inputs) {
  return reading::StudyFile(expand(inputs).front(), reading::Require::any_part).header();
}

void merge_shards(std::span<const ShardInfo> shards, const study::Study& study, const fs::path& output,
                  layout::RowRange rows, const StatisticsOfPoints& statistics,
                  const layout::Provenance& provenance, const Renumbering& renumber,
                  const layout::MeasureTable& measures) {
  std::vector<ShardInfo> ordered(shards.begin(), shards.end());
  sort_by_rows(ordered);
  require_cover(ordered, rows, output);
  const storage::UnfinishedFile part(output);
  hdf5::WrittenValues written = write_trials_of(ordered, study, part.path(), rows,
                                                merged_provenance(ordered, provenance), renumber, measures);
  layout::StoredStatistics stored;
  if (statistics && rows == layout::all_rows(study))
    stored = statistics_of(part.path(), written, statistics, measures);
  finish_results(output, write_statistics(part.path(), study, rows, std::move(written), stored));
}

}  // namespace zerocount::shards
