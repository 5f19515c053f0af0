#include "results/reading/export.hpp"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <functional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/groupings.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::reading {
namespace {

namespace fs = std::filesystem;

/// Calls `take(first, count)` for successive ranges of at most `size` numbers in [first, end).
void for_each_block(std::int64_t first, std::int64_t end, std::int64_t size,
                    const std::function<void(std::int64_t, std::int64_t)>& take) {
  for (; first < end; first += size) take(first, std::min(size, end - first));
}

template <class Record>
void add_names(CsvFile& csv, const std::vector<layout::RecordField<Record>>& fields,
               parameters::AxisKind axis) {
  for (const layout::RecordField<Record>& field : fields)
    csv.add(head_with_unit(field.column.name, parameters::unit_on(axis, field.column.unit)));
}

template <class Record>
void add_values(CsvFile& csv, const std::vector<layout::RecordField<Record>>& fields, const Record& record) {
  for (const layout::RecordField<Record>& field : fields) csv.add(value_text(field, record));
}

/// Writes a table with one row per record, and no other columns.
/// @param read read(first, count) returns some of the `rows` records.
template <class Record, class Read>
void export_records(const std::vector<layout::RecordField<Record>>& fields, std::int64_t rows,
                    const Read& read, parameters::AxisKind axis, CsvFile& csv) {
  add_names(csv, fields, axis);
  csv.end_row();
  for_each_block(0, rows, layout::chunk_elements, [&](std::int64_t first, std::int64_t count) {
    for (const Record& record : read(first, count)) {
      add_values(csv, fields, record);
      csv.end_row();
    }
  });
}

void export_points(const ResultsFile& file, CsvFile& csv) {
  const std::vector<std::string> labels = file.point_labels();
  const std::vector<study::SweepAxis> axes = file.axes();
  const std::vector<layout::PointColumn> statistics = file.statistics();
  csv.add("point", "label");
  for (const study::SweepAxis& axis : axes) csv.add(head_with_unit(axis.name, axis.unit));
  for (const layout::PointColumn& statistic : statistics)
    csv.add(head_with_unit(statistic.name, statistic.unit));
  csv.end_row();
  for (std::size_t point = 0; point < labels.size(); ++point) {
    csv.add(static_cast<std::int64_t>(point), labels[point]);
    for (const study::SweepAxis& axis : axes) {
      if (axis.kind == study::SweepAxis::Kind::text) {
        csv.add(axis.texts.at(point));
      } else {
        csv.add(axis.numbers.at(point));
      }
    }
    for (const layout::PointColumn& statistic : statistics) csv.add(statistic.values.at(point));
    csv.end_row();
  }
}

void export_trials(const TrialTables& trials, std::int64_t trials_of_point, CsvFile& csv) {
  csv.add("trial", "point", "index");
  for (const study::InputColumn& input : trials.input_columns())
    csv.add(head_with_unit(input.name, input.unit));
  csv.end_row();
  trials.for_each_block([&](layout::RowRange block) {
    std::vector<std::vector<double>> inputs;
    for (std::size_t column = 0; column < trials.input_columns().size(); ++column)
      inputs.push_back(trials.input(column, block));
    std::size_t position = 0;
    for (const std::int64_t row : trials.rows(block)) {
      csv.add(row, row / trials_of_point, row % trials_of_point);
      for (const std::vector<double>& values : inputs) csv.add(values[position]);
      csv.end_row();
      ++position;
    }
  });
}

void export_outcomes(const TrialTables& trials, CsvFile& csv) {
  csv.add("trial", "move");
  add_names(csv, trials.measures(), trials.features().axis);
  csv.end_row();
  const std::int64_t moves = trials.moves();
  trials.for_each_block([&](layout::RowRange block) {
    const std::vector<std::int64_t> rows = trials.rows(block);
    std::int64_t position = 0;
    for (const trial::MoveOutcome& outcome : trials.outcomes(block)) {
      csv.add(rows[static_cast<std::size_t>(position / moves)], position % moves);
      add_values(csv, trials.measures(), outcome);
      csv.end_row();
      ++position;
    }
  });
}

void export_jerks(const TrialTables& trials, CsvFile& csv) {
  const auto read = [&](std::int64_t first, std::int64_t count) { return trials.jerks_at(first, count); };
  export_records(layout::jerk_fields(), trials.jerk_count(), read, trials.features().axis, csv);
}

/// Adds the tables of trials, outcomes, jerks and samples to the tables to export.
/// @param trials must live as long as the tables.
/// @param trials_of_point number of trials per design point.
void add_trial_tables(std::vector<ExportedTable>& tables, const TrialTables& trials,
                      std::int64_t trials_of_point) {
  tables.push_back({"trials.csv", [&trials, trials_of_point](const ResultsFile&, CsvFile& csv) {
                      export_trials(trials, trials_of_point, csv);
                    }});
  tables.push_back(
      {"outcomes.csv", [&trials](const ResultsFile&, CsvFile& csv) { export_outcomes(trials, csv); }});
  tables.push_back({"jerks.csv", [&trials](const ResultsFile&, CsvFile& csv) { export_jerks(trials, csv); }});
}

void export_profiles(const ResultsFile& file, CsvFile& csv) {
  const std::vector<StoredProfile> profiles = file.profiles();
  const bool of_machines =
      std::any_of(profiles.begin(), profiles.end(), [](const StoredProfile& p) { return p.machines > 0; });
  csv.add("profile");
  if (of_machines) csv.add("machine");
  csv.add(head_with_unit("theta", profiles.front().theta_unit), "value", "unit of value");
  csv.end_row();
  for (const StoredProfile& profile : profiles) {
    const std::size_t angles = profile.theta.size();
    for (std::size_t i = 0; i < profile.value.size(); ++i) {
      csv.add(profile.name);
      if (profile.machines > 0) {
        csv.add(static_cast<std::int64_t>(i / angles));
      } else if (of_machines) {
        csv.add("");
      }
      csv.add(profile.theta[i % angles], profile.value[i], profile.unit);
      csv.end_row();
    }
  }
}

/// Writes the groups of a grouping: the inputs of machines or worlds, or the names of conditions, one row per
/// group.
void export_groups(const layout::Grouping& grouping, const StoredGroups& groups, CsvFile& csv) {
  csv.add(grouping.name);
  if (!groups.names.empty()) csv.add("name");
  for (const study::InputColumn& column : groups.columns) csv.add(head_with_unit(column.name, column.unit));
  csv.end_row();
  for (std::int64_t group = 0; group < groups.count; ++group) {
    csv.add(group);
    if (!groups.names.empty()) csv.add(groups.names[static_cast<std::size_t>(group)]);
    for (const std::vector<double>& values : groups.inputs) csv.add(values[static_cast<std::size_t>(group)]);
    csv.end_row();
  }
}

/// Writes statistics with one row per design point and group. The group is given by its number or its age.
void export_by_group(const layout::Grouping& grouping, const StoredGroups& groups,
                     const std::vector<layout::PointColumn>& columns, CsvFile& csv) {
  csv.add("point", head_with_unit(grouping.name, groups.unit));
  for (const layout::PointColumn& column : columns) csv.add(head_with_unit(column.name, column.unit));
  csv.end_row();
  const auto count = static_cast<std::size_t>(groups.count);
  for (std::size_t i = 0; i < columns.front().values.size(); ++i) {
    csv.add(static_cast<std::int64_t>(i / count));
    csv.add(groups.values.empty() ? static_cast<double>(i % count) : groups.values[i % count]);
    for (const layout::PointColumn& column : columns) csv.add(column.values[i]);
    csv.end_row();
  }
}

/// Adds the tables of a grouping of trials, such as machines.csv and machine_counts.csv, to the tables to
/// export. Ages have only ages.csv, because nothing but counts is known of them. The lives of machines are in
/// lives.csv.
void add_groups(std::vector<ExportedTable>& tables, const ResultsFile& file,
                const layout::Grouping& grouping) {
  const std::optional<StoredGroups> found = file.groups(grouping.name);
  if (!found) return;
  const std::string name(grouping.name);
  const auto add_by_group = [&](const std::string& table, std::vector<layout::PointColumn> columns) {
    tables.push_back({table, [&grouping, groups = *found, columns](const ResultsFile&, CsvFile& csv) {
                        export_by_group(grouping, groups, columns, csv);
                      }});
  };
  std::vector<layout::PointColumn> counts;
  const auto add_count = [&](const char* column, const std::vector<std::int64_t>& values) {
    if (!values.empty()) counts.push_back({column, "1", "", {values.begin(), values.end()}});
  };
  add_count("success", found->success);
  add_count("trials", found->trials);
  add_count("goal_met", found->goal_met);
  if (grouping.has_values) {
    counts.insert(counts.end(), found->statistics.begin(), found->statistics.end());
    if (!counts.empty()) add_by_group(name + "s.csv", std::move(counts));
    return;
  }
  tables.push_back({name + "s.csv", [&grouping, groups = *found](const ResultsFile&, CsvFile& csv) {
                      export_groups(grouping, groups, csv);
                    }});
  if (!counts.empty()) add_by_group(name + "_counts.csv", std::move(counts));
  if (!found->statistics.empty()) add_by_group("lives.csv", found->statistics);
}

void export_trace(const TrialTables& trials, CsvFile& csv) {
  const auto read = [&](std::int64_t first, std::int64_t count) { return trials.trace_at(first, count); };
  export_records(layout::trace_fields(trials.features()), trials.trace_count(), read, trials.features().axis,
                 csv);
}

/// Writes statistics with a second dimension: one row per design point and index of that dimension.
void export_statistics(const layout::StatisticTable& table, CsvFile& csv) {
  csv.add("point", table.group->dimension);
  for (const layout::PointColumn& column : table.columns) csv.add(head_with_unit(column.name, column.unit));
  csv.end_row();
  const std::size_t rows = table.columns.empty() ? 0 : table.columns.front().values.size();
  for (std::size_t row = 0; row < rows; ++row) {
    csv.add(static_cast<std::int64_t>(row) / table.width, static_cast<std::int64_t>(row) % table.width);
    for (const layout::PointColumn& column : table.columns) csv.add(column.values[row]);
    csv.end_row();
  }
}

void add_study_tables(std::vector<ExportedTable>& tables, const ResultsFile& file) {
  if (file.has_profiles()) tables.push_back({"profiles.csv", export_profiles});
  for (const layout::Grouping& grouping : layout::groupings()) add_groups(tables, file, grouping);
}

void add_statistic_tables(std::vector<ExportedTable>& tables, const ResultsFile& file) {
  for (const layout::StatisticTable& table : file.statistic_tables()) {
    tables.push_back({std::string(table.group->csv),
                      [table](const ResultsFile&, CsvFile& csv) { export_statistics(table, csv); }});
  }
}

/// Writes the tables as CSV files. No file gets its final name before all are complete, so that a failure
/// leaves nothing that would stop the next attempt.
/// @returns the paths of the files.
std::vector<fs::path> write_tables(const std::vector<ExportedTable>& tables, const ResultsFile& file,
                                   const fs::path& directory, ExistingFiles existing) {
  std::vector<fs::path> paths(tables.size());
  std::transform(tables.begin(), tables.end(), paths.begin(),
                 [&directory](const ExportedTable& table) { return directory / table.name; });
  std::error_code unknown;
  if (fs::exists(directory, unknown) && !fs::is_directory(directory, unknown)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: not a directory; name one, which is made if need be", directory.string()));
  }
  storage::make_directory(directory);
  for (const fs::path& path : paths) {
    std::error_code ignored;
    if (existing == ExistingFiles::refuse && fs::exists(fs::symlink_status(path, ignored))) {
      throw Failure(ExitCode::bad_input, fmt::format("{}: exists already; --force replaces it, or name "
                                                     "another directory",
                                                     path.string()));
    }
  }
  std::deque<CsvFile> written;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    CsvFile& csv = written.emplace_back(paths[i]);
    tables[i].write(file, csv);
    csv.finish();
  }
  for (CsvFile& csv : written) csv.publish();
  return paths;
}

}  // namespace

std::vector<fs::path> export_csv(const ResultsFile& file, const fs::path& directory,
                                 const std::vector<ExportedTable>& further, ExistingFiles existing) {
  const std::optional<TrialTables>& trials = file.trials();
  std::vector<ExportedTable> tables{{"points.csv", export_points}};
  if (trials) add_trial_tables(tables, *trials, file.header().trials);
  add_study_tables(tables, file);
  if (trials && trials->has_trace()) {
    tables.push_back(
        {"trace.csv", [&trials](const ResultsFile&, CsvFile& csv) { export_trace(*trials, csv); }});
  }
  add_statistic_tables(tables, file);
  tables.insert(tables.end(), further.begin(), further.end());
  return write_tables(tables, file, directory, existing);
}

}  // namespace zerocount::reading
