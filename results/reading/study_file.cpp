#include "results/reading/study_file.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/measure_table.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/validation.hpp"

namespace zerocount::reading {
namespace {

constexpr std::size_t columns_before_inputs = 2;  // point and index

layout::FileHeader read_required(const hdf5::File& file, const std::filesystem::path& path, Require require) {
  layout::FileHeader header = layout::read_header(file);
  if (!header.finished && require != Require::unfinished) file.fail("it was never finished");
  if (!header.complete && require == Require::complete) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: incomplete: it holds trials {} to {} of {}; run the others and join them with "
                    "'zerocount merge'",
                    path.string(), header.rows.first, header.rows.end() - 1, header.trials * header.points));
  }
  return header;
}

/// The datasets of the group `input` of /trial or /rig.
std::vector<study::InputColumn> read_input_columns(const hdf5::Group& table) {
  std::vector<study::InputColumn> inputs;
  if (!table.contains("input")) return inputs;
  const hdf5::Group group = table.open_group("input");
  for (const std::string& name : group.children()) {
    const hdf5::Dataset dataset = group.open_dataset(name);
    inputs.push_back({name, dataset.text("units"), dataset.text("long_name")});
  }
  return inputs;
}

/// The axis by the unit of a position, and the features by their columns.
study::StudyFeatures read_features(const hdf5::File& file, const layout::MeasureTable& table) {
  const hdf5::Group outcome = file.open_group("outcome");
  study::StudyFeatures features;
  if (outcome.open_dataset("final_position").text("units") ==
      parameters::unit_on(parameters::AxisKind::linear, "rad"))
    features.axis = parameters::AxisKind::linear;
  for (const layout::Measure& measure : table) {
    if (measure.file.only_with != nullptr)
      features.*measure.file.only_with = outcome.contains(measure.field.column.name);
  }
  if (!file.contains("trace")) return features;
  const hdf5::Group trace = file.open_group("trace");
  features.travel = trace.contains("reference");
  features.phases = trace.contains("phase");
  features.load = trace.contains("load_theta");
  features.drive_torque = trace.contains("drive_torque");
  return features;
}

std::optional<layout::TableIo> open_trace(const hdf5::File& file, const study::StudyFeatures& features) {
  if (!file.contains("trace")) return std::nullopt;
  return layout::TableIo::open(file, layout::trace_table(features));
}

std::vector<double> read_doubles(const hdf5::Dataset& dataset) {
  if (dataset.element() != hdf5::Element::float64 || dataset.extent().size() != 1)
    dataset.fail("it should be numbers in one dimension");
  std::vector<double> values(dataset.extent()[0]);
  dataset.read(0, std::ssize(values), values.data());
  return values;
}

/// Requires one value per design point.
void require_points(const hdf5::Dataset& dataset, std::int64_t points) {
  if (dataset.extent() == std::vector<hdf5::Size>{static_cast<hdf5::Size>(points)}) return;
  dataset.fail(fmt::format("it should have one value for each of the {} design points", points));
}

/// The columns of /point with this role, and their names; none in a shard.
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

}  // namespace

StudyFile::StudyFile(const std::filesystem::path& path, Require require, const layout::MeasureTable& table)
    : path_(path),
      file_(layout::open_results(
          path, require == Require::unfinished ? layout::Checksum::not_yet : layout::Checksum::required)),
      header_(read_required(file_, path, require)),
      features_(read_features(file_, table)),
      inputs_(read_input_columns(file_.open_group("trial"))),
      trials_(layout::TableIo::open(file_, layout::trial_table(inputs_))),
      table_(&table),
      measures_(layout::outcome_fields(header_.version, features_, table)),
      outcomes_(layout::TableIo::open(file_, layout::outcome_table(header_.version, features_, table))),
      jerks_(layout::TableIo::open(file_, layout::jerk_table())),
      trace_(open_trace(file_, features_)) {
  if (trials_.rows() != rows().count)
    trials_.row_scale().fail("its size differs from the attribute 'trial_count'");
  if (outcomes_.rows() != rows().count)
    outcomes_.row_scale().fail("its size differs from the attribute 'trial_count'");
  validate_numbering(header_, trials_, jerks_);
}

std::int64_t StudyFile::local(layout::RowRange range) const {
  if (range.first < rows().first || range.count < 0 || range.end() > rows().end()) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: trials {} to {} were asked for; it holds {} to {}", path_.string(),
                              range.first, range.end() - 1, rows().first, rows().end() - 1));
  }
  return range.first - rows().first;
}

std::vector<std::string> StudyFile::point_labels() const {
  if (!file_.contains("point")) return {};
  const hdf5::Dataset labels = file_.open_group("point").open_dataset("label");
  require_points(labels, header_.points);
  return labels.read_texts();
}

std::vector<study::SweepAxis> StudyFile::axes() const {
  std::vector<study::SweepAxis> axes;
  for (const auto& [name, dataset] : point_columns(file_, header_.points, "axis")) {
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

std::vector<layout::PointColumn> StudyFile::statistics() const {
  std::vector<layout::PointColumn> statistics;
  for (const auto& [name, dataset] : point_columns(file_, header_.points, "statistic"))
    statistics.push_back({name, dataset.text("units"), dataset.text("long_name"), read_doubles(dataset)});
  return statistics;
}

std::vector<double> StudyFile::input(std::size_t column, layout::RowRange range) const {
  const std::int64_t first = local(range);
  std::vector<double> values(static_cast<std::size_t>(range.count));
  trials_.column(columns_before_inputs + column).read(first, range.count, values.data());
  return values;
}

std::vector<double> StudyFile::inputs_of(std::int64_t row) const {
  std::vector<double> values;
  for (std::size_t column = 0; column < inputs_.size(); ++column)
    values.push_back(input(column, {row, 1}).front());
  return values;
}

std::vector<trial::MoveOutcome> StudyFile::outcomes(layout::RowRange range) const {
  std::vector<trial::MoveOutcome> moves =
      layout::read_records(outcomes_, measures_, local(range), range.count);
  validate_outcomes(outcomes_, measures_, range.first, moves);
  return moves;
}

std::vector<double> StudyFile::measure(std::string_view name, layout::RowRange range) const {
  const auto known = std::find_if(table_->begin(), table_->end(), [name](const layout::Measure& measure) {
    return measure.field.column.name == name;
  });
  if (known == table_->end()) throw std::invalid_argument(fmt::format("'{}' is no measure of a move", name));

  const layout::RecordField<trial::MoveOutcome>& field = known->field;
  const std::int64_t first = local(range);
  const auto size = static_cast<std::size_t>(range.count * outcomes_.width());
  const auto column = std::find_if(measures_.begin(), measures_.end(),
                                   [name](const auto& one) { return one.column.name == name; });
  if (column == measures_.end()) return std::vector<double>(size, known->file.before);
  std::vector<trial::MoveOutcome> moves(size);
  if (layout::is_computed(field)) {
    moves = outcomes(range);
  } else {
    std::vector<std::byte> bytes(size * hdf5::size_of(field.column.element));
    outcomes_.column(static_cast<std::size_t>(column - measures_.begin()))
        .read(first, range.count, bytes.data());
    layout::scatter(field, bytes, std::span(moves));
    validate_measure(outcomes_, measures_, name, range.first, moves);
  }
  std::vector<double> values(size);
  std::transform(moves.begin(), moves.end(), values.begin(),
                 [&](const trial::MoveOutcome& move) { return layout::value_of(field, move); });
  return values;
}

std::vector<layout::JerkRecord> StudyFile::jerks_at(std::int64_t first, std::int64_t count) const {
  std::vector<layout::JerkRecord> jerks = layout::read_records(jerks_, layout::jerk_fields(), first, count);
  validate_jerks(jerks_, moves(), first, jerks);
  return jerks;
}

std::int64_t StudyFile::first_jerk_from(std::int64_t row) const {
  const hdf5::Dataset& trial = jerks_.column(0);
  std::int64_t low = 0;
  std::int64_t high = jerks_.rows();
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    std::int64_t value = 0;
    trial.read(middle, 1, &value);
    if (value < row) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

std::vector<layout::JerkRecord> StudyFile::jerks(layout::RowRange range) const {
  local(range);
  const std::int64_t first = first_jerk_from(range.first);
  return jerks_at(first, first_jerk_from(range.end()) - first);
}

void StudyFile::require_valid_values() const {
  const std::int64_t at_once = layout::chunk_rows(moves());
  for (std::int64_t first = rows().first; first < rows().end(); first += at_once) {
    const layout::RowRange block{first, std::min(at_once, rows().end() - first)};
    outcomes(block);
    for (std::size_t column = 0; column < inputs_.size(); ++column) input(column, block);
  }
  for (std::int64_t first = 0; first < jerk_count(); first += layout::chunk_elements)
    jerks_at(first, std::min(layout::chunk_elements, jerk_count() - first));
  for (std::int64_t first = 0; first < trace_count(); first += layout::chunk_elements)
    trace_at(first, std::min(layout::chunk_elements, trace_count() - first));
}

std::vector<layout::TraceRecord> StudyFile::trace_at(std::int64_t first, std::int64_t count) const {
  if (!trace_) return {};
  std::vector<layout::TraceRecord> records =
      layout::read_records(*trace_, layout::trace_fields(features_), first, count);
  for (layout::TraceRecord& record : records) {
    if (!features_.travel) record.reference = record.target;
    if (!features_.drive_torque) record.drive_torque = record.torque;
  }
  return records;
}

std::vector<layout::StatisticTable> StudyFile::statistic_tables() const {
  return layout::read_statistic_tables(file_);
}

std::vector<StoredProfile> StudyFile::profiles() const {
  std::vector<StoredProfile> profiles;
  if (!has_profiles()) return profiles;
  const hdf5::Group group = file_.open_group("profile");
  for (const std::string& name : group.children()) {
    const hdf5::Group folder = group.open_group(name);
    const std::string unit = folder.open_dataset("value").text("units");
    StoredProfile profile{name, unit, read_doubles(folder.open_dataset("theta")), {}};
    const bool of_rigs = folder.contains("rig");
    const layout::TableIo io = layout::TableIo::open(
        file_, of_rigs ? layout::rotor_table(name, unit) : layout::profile_table(name, unit));
    if (of_rigs) profile.rigs = io.rows();
    profile.value = layout::read_column<double>(io, 0);
    profiles.push_back(std::move(profile));
  }
  return profiles;
}

std::optional<StoredRigs> StudyFile::rigs() const {
  if (!file_.contains("rig")) return std::nullopt;
  StoredRigs stored;
  const hdf5::Group group = file_.open_group("rig");
  stored.columns = read_input_columns(group);
  const layout::TableIo io = layout::TableIo::open(file_, layout::rig_table(stored.columns));
  stored.rigs = io.rows();
  for (std::size_t column = 0; column < stored.columns.size(); ++column) {
    stored.inputs.push_back(layout::read_column<double>(io, column));
  }
  if (!group.contains("success")) return stored;
  const layout::TableIo counts = layout::TableIo::open(file_, layout::rig_count_table());
  stored.success = layout::read_column<std::int64_t>(counts, 0);
  stored.trials = layout::read_column<std::int64_t>(counts, 1);
  validate_rigs(header_, counts, stored.success, stored.trials);
  return stored;
}

}  // namespace zerocount::reading
