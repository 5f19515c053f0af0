#include "results/reading/results_file.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/groupings.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/validation.hpp"

namespace zerocount::reading {
namespace {

void require_extent(const layout::FileHeader& header, const std::filesystem::path& path, Require require) {
  if (!header.finished && require != Require::unfinished) {
    throw Failure(ExitCode::bad_data, fmt::format("{}: damaged: it was never finished", path.string()));
  }
  if (!header.complete && require == Require::complete) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: incomplete: it holds trials {} to {} of {}; run the others and join them with "
                    "'zerocount merge'",
                    path.string(), header.rows.first, header.rows.end() - 1, header.trials * header.points));
  }
}

TrialSource trials_in(const ShardFile& shard, const study::Study& study) {
  return {study.features, study.columns.inputs, !study.retained_trials.empty(),
          [&](const layout::Table& table) { return shard.open(table, study.moves); }};
}

void require_numbers(const hdf5::Dataset& dataset, std::size_t dimensions) {
  if (dataset.element() == hdf5::Element::float64 && dataset.extent().size() == dimensions) return;
  dataset.fail(
      fmt::format("it should be numbers in {}", dimensions == 1 ? "one dimension" : "two dimensions"));
}

std::vector<double> read_doubles(const hdf5::Dataset& dataset) {
  require_numbers(dataset, 1);
  std::vector<double> values(dataset.extent()[0]);
  dataset.read(0, std::ssize(values), values.data());
  return values;
}

/// Checks that a dataset has one value per design point.
/// @throws Failure (bad_data) otherwise.
void require_points(const hdf5::Dataset& dataset, std::int64_t points) {
  const std::vector<hdf5::Size> extent = dataset.extent();
  if (!extent.empty() && extent.size() <= 2 && extent[0] == static_cast<hdf5::Size>(points)) return;
  dataset.fail(fmt::format("it should have one value for each of the {} design points", points));
}

/// The columns of the table /point with this role ("axis" or "statistic"), as pairs of name and dataset; none
/// in a shard.
std::vector<std::pair<std::string, hdf5::Dataset>> point_columns(const hdf5::File& file, std::int64_t points,
                                                                 std::string_view role) {
  std::vector<std::pair<std::string, hdf5::Dataset>> columns;
  if (!file.contains("point")) return columns;
  const hdf5::Group group = file.open_group("point");
  for (const std::string& name : group.children()) {
    hdf5::Dataset dataset = group.open_dataset(name);
    if (!dataset.has_attribute("role") || dataset.text("role") != role) continue;
    require_points(dataset, points);
    columns.emplace_back(name, std::move(dataset));
  }
  return columns;
}

/// Names of the columns that a dataset [point, band] or [point, tolerance] stands for, one per error band or
/// tolerance.
std::vector<std::string> names_by_limit(const hdf5::File& file, const std::string& name) {
  std::vector<std::string> names;
  if (layout::is_of_tolerance(name)) {
    const trial::Tolerances tolerances = read_tolerances(file);
    for (const double one : tolerances.values()) names.push_back(layout::name_of_tolerance(name, one));
  } else {
    const trial::ErrorBands bands = read_bands(file);
    for (const std::int64_t band : bands.values()) names.push_back(layout::name_of_band(name, band));
  }
  return names;
}

/// Appends to `columns` one column for each error band, or tolerance, of the dataset [point, band].
void append_limits(const hdf5::File& file, const layout::PointColumn& column, const hdf5::Dataset& dataset,
                   std::vector<layout::PointColumn>& columns) {
  require_numbers(dataset, 2);
  const std::vector<std::string> names = names_by_limit(file, column.name);
  const std::size_t points = dataset.extent()[0];
  if (dataset.extent()[1] != names.size()) dataset.fail("its size differs from that of its axes");
  std::vector<double> values(points * names.size());
  dataset.read(0, static_cast<std::int64_t>(points), values.data());
  for (std::size_t slot = 0; slot < names.size(); ++slot) {
    layout::PointColumn& one = columns.emplace_back(column);
    one.name = names[slot];
    for (std::size_t point = 0; point < points; ++point)
      one.values.push_back(values[point * names.size() + slot]);
  }
}

/// Index of the first number of each design point in the numbers of /sums, [point], followed by the end of
/// the last point.
std::vector<std::int64_t> begins_of(const layout::TableReader& counts, std::size_t column,
                                    const layout::TableReader& numbers) {
  std::vector<std::int64_t> begins{0};
  for (const std::int64_t count : layout::read_column<std::int64_t>(counts, column)) {
    if (count < 0 || count > numbers.rows() - begins.back()) break;
    begins.push_back(begins.back() + count);
  }
  if (std::ssize(begins) != counts.rows() + 1 || begins.back() != numbers.rows())
    counts.column(column).fail("its counts are not those of the numbers in the file");
  return begins;
}

template <class Number>
std::vector<Number> numbers_of(const layout::TableReader& io, const std::vector<std::int64_t>& begins,
                               std::size_t point) {
  const std::int64_t count = begins[point + 1] - begins[point];
  std::vector<Number> numbers(static_cast<std::size_t>(count));
  io.column(0).read(begins[point], count, numbers.data());
  return numbers;
}

/// The statistics of a grouping's groups at the design points: all datasets of numbers in two dimensions in
/// the HDF5 group.
std::vector<layout::PointColumn> group_statistics(const hdf5::Group& group) {
  std::vector<layout::PointColumn> statistics;
  for (const std::string& name : group.children()) {
    if (group.is_group(name)) continue;
    const hdf5::Dataset dataset = group.open_dataset(name);
    if (dataset.element() != hdf5::Element::float64 || dataset.extent().size() != 2) continue;
    statistics.push_back({name, dataset.text("units"), dataset.text("long_name"), {}});
  }
  return statistics;
}

/// Reads the counts and statistics of a grouping's groups into `stored`. A part of a study does not have
/// them.
void read_counts(const hdf5::File& file, const layout::FileHeader& header, const layout::Grouping& grouping,
                 StoredGroups& stored) {
  const hdf5::Group group = file.open_group(std::string(grouping.name));
  if (!group.contains("success")) return;
  const bool has_goal = group.contains("goal_met");
  stored.statistics = group_statistics(group);
  const layout::TableIo counts = layout::TableIo::open(
      file, layout::group_count_table(grouping, has_goal, stored.statistics, stored.unit));
  stored.success = layout::read_column<std::int64_t>(counts, 0);
  stored.trials = layout::read_column<std::int64_t>(counts, 1);
  if (has_goal) stored.goal_met = layout::read_column<std::int64_t>(counts, 2);
  std::size_t column = has_goal ? 3 : 2;
  for (layout::PointColumn& statistic : stored.statistics)
    statistic.values = layout::read_column<double>(counts, column++);
  validate_groups(grouping, header, counts, stored);
}

}  // namespace

ResultsFile::ResultsFile(const std::filesystem::path& path, Require require,
                         const layout::MeasureTable* table, const study::Study* study)
    : path_(path) {
  const bool checked = require == Require::unfinished;
  const auto opened = std::make_shared<Opened>();
  opened_ = opened;
  if (is_shard(path)) {
    opened->shard.emplace(path, checked ? layout::Checksum::not_yet : layout::Checksum::required);
  } else {
    opened->file.emplace(checked ? hdf5::File::open_to_read(path) : layout::open_results(path));
  }
  const std::optional<ShardFile>& shard = opened->shard;
  header_ = std::make_shared<const layout::FileHeader>(shard ? shard->header() : layout::read_header(file()));
  require_extent(header(), path, require);
  if (shard && study != nullptr) study_ = {std::shared_ptr<void>(), study};  // not owned
  if (layout::has_trials(header().retention)) {
    const layout::MeasureTable& measures = table != nullptr ? *table : layout::measure_table();
    opened->trials.emplace(shard ? trials_in(*shard, this->study()) : trials_in(file(), measures), header(),
                           table);
  }
  const auto open = [&](const layout::Table& one) {
    return shard ? shard->open(one, 1) : layout::TableReader::open(file(), one);
  };
  if (layout::has_sums(header().retention)) opened->sums.emplace(open, points());
}

const study::Study& ResultsFile::study() const {
  if (!study_) {
    study::Study study = layout::recorded_study(header(), path_);
    // Earlier builds did not measure the load beside a goal of the motor.
    if (trials() && !trials()->features().load_error)
      for (study::Goal& goal : study.goals) goal.beside_load = goal.beside_load && goal.of_other_mass;
    study_ = std::make_shared<const study::Study>(std::move(study));
  }
  return *study_;
}

void ResultsFile::show_study(study::Study study) {
  layout::FileHeader shown = header();
  shown.trials = study.trials;
  shown.rows = {0, study::trial_count(study)};
  header_ = std::make_shared<const layout::FileHeader>(std::move(shown));
  study_ = std::make_shared<const study::Study>(std::move(study));
  shows_part_ = true;
}

std::vector<std::string> ResultsFile::point_labels() const {
  if (!contains("point")) return {};
  const hdf5::Dataset labels = file().open_group("point").open_dataset("label");
  require_points(labels, header().points);
  return labels.read_texts();
}

std::vector<study::SweepAxis> ResultsFile::axes() const {
  std::vector<study::SweepAxis> axes;
  if (!opened_->file) return axes;
  for (const auto& [name, dataset] : point_columns(file(), header().points, "axis")) {
    study::SweepAxis axis{
        name, dataset.text("units"), dataset.text("long_name"), study::SweepAxis::Kind::number, {}, {}};
    if (dataset.element() == hdf5::Element::text) {
      axis.kind = study::SweepAxis::Kind::text;
      axis.unit.clear();
      axis.texts = dataset.read_texts();
    } else {
      axis.numbers = read_doubles(dataset);
    }
    axes.push_back(std::move(axis));
  }
  return axes;
}

std::vector<layout::PointColumn> ResultsFile::statistics() const {
  std::vector<layout::PointColumn> statistics;
  if (shows_part_ || !opened_->file) return statistics;
  for (const auto& [name, dataset] : point_columns(file(), header().points, "statistic")) {
    const layout::PointColumn column{name, dataset.text("units"), dataset.text("long_name"), {}};
    if (dataset.extent().size() == 2) {
      append_limits(file(), column, dataset, statistics);
    } else {
      statistics.push_back(column);
      statistics.back().values = read_doubles(dataset);
    }
  }
  return statistics;
}

std::vector<layout::StatisticTable> ResultsFile::statistic_tables() const {
  return opened_->file ? layout::read_statistic_tables(file()) : std::vector<layout::StatisticTable>();
}

std::vector<StoredProfile> ResultsFile::profiles() const {
  std::vector<StoredProfile> profiles;
  if (!has_profiles()) return profiles;
  const hdf5::Group group = file().open_group("profile");
  for (const std::string& name : group.children()) {
    const hdf5::Group folder = group.open_group(name);
    const std::string unit = folder.open_dataset("value").text("units");
    StoredProfile profile{name, unit, read_doubles(folder.open_dataset("theta")), {}};
    profile.theta_unit = folder.open_dataset("theta").text("units");
    const bool of_machines = folder.contains("machine");
    const layout::TableIo io = layout::TableIo::open(
        file(), of_machines ? layout::rotor_table(name, unit) : layout::profile_table(name, unit));
    if (of_machines) profile.machines = io.rows();
    profile.value = layout::read_column<double>(io, 0);
    profiles.push_back(std::move(profile));
  }
  return profiles;
}

std::optional<StoredGroups> ResultsFile::groups(std::string_view name) const {
  if (!contains(std::string(name))) return std::nullopt;
  const layout::Grouping& grouping = layout::grouping_named(name);
  StoredGroups stored;
  stored.columns = read_input_columns(file().open_group(std::string(name)));
  const layout::TableIo io =
      layout::TableIo::open(file(), layout::group_table(grouping, stored.columns, stored.unit));
  stored.count = io.rows();
  for (std::size_t column = 0; column < stored.columns.size(); ++column)
    stored.inputs.push_back(layout::read_column<double>(io, column));
  if (grouping.has_labels) stored.names = io.column(stored.columns.size()).read_texts();
  if (grouping.has_values) {
    stored.values = read_doubles(io.row_scale());
    stored.unit = io.row_scale().text("units");
  }
  read_counts(file(), header(), grouping, stored);
  return stored;
}

ResultsFile::StoredSums::StoredSums(const std::function<layout::TableReader(const layout::Table&)>& open,
                                    std::int64_t points)
    : whole(open(layout::whole_sums_table())), real(open(layout::real_sums_table())) {
  const layout::TableReader counts = open(layout::sums_table());
  if (counts.rows() != points)
    counts.row_scale().fail("it should have the design points of the file's trials");
  whole_begin = begins_of(counts, 0, whole);
  real_begin = begins_of(counts, 1, real);
}

layout::RowRange ResultsFile::rows_of(std::int64_t point) const {
  const std::int64_t first = std::max(rows().first, point * header().trials);
  return {first, std::min(rows().end(), (point + 1) * header().trials) - first};
}

layout::PointSums ResultsFile::sums(std::int64_t index) const {
  if (!opened_->sums) throw layout::ForeignFile(path_, "it keeps every trial; expected a file of statistics");
  if (opened_->file && file().text("sums_form") != layout::sums_form()) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: its sums are not in the form of this program; zerocount {}, which wrote them, "
                    "reads them, and 'zerocount export' has the statistics that it stored",
                    path_.string(), header().provenance.zerocount_version));
  }
  const auto point = static_cast<std::size_t>(index);
  return {numbers_of<std::int64_t>(opened_->sums->whole, opened_->sums->whole_begin, point),
          numbers_of<double>(opened_->sums->real, opened_->sums->real_begin, point)};
}

}  // namespace zerocount::reading
