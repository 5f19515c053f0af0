#include "results/reading/trial_tables.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "core/numerics/roots.hpp"
#include "results/layout/measure_table.hpp"
#include "results/reading/validation.hpp"

namespace zerocount::reading {
namespace {

/// Number of columns in the table /trial before the inputs: point and index.
constexpr std::size_t columns_before_inputs = 2;

/// Derives the study's features from the file: the kind of axis from the unit of a position, the others from
/// the columns that exist.
study::StudyFeatures read_features(const hdf5::File& file, const layout::MeasureTable& measures) {
  const hdf5::Group outcome = file.open_group("outcome");
  study::StudyFeatures features;
  features.bands = read_bands(file);
  features.tolerances = read_tolerances(file);
  if (outcome.open_dataset("final_position").text("units") ==
      parameters::unit_on(parameters::AxisKind::linear, "rad"))
    features.axis = parameters::AxisKind::linear;
  for (const layout::Measure& measure : measures) {
    if (measure.only_with != nullptr)
      features.*measure.only_with = outcome.contains(measure.field.column.name);
  }
  if (!file.contains("trace")) return features;
  const hdf5::Group trace = file.open_group("trace");
  features.travel = trace.contains("reference");
  features.phases = trace.contains("phase");
  features.load = trace.contains("load_theta");
  features.load_count = trace.contains("load_count");
  features.motor_count = trace.contains("motor_count");
  features.drive_torque = trace.contains("drive_torque");
  return features;
}

/// Index of the first of `size` ascending numbers that is at least `number`; `size` if there is none.
std::int64_t first_not_below(const hdf5::RowSource& numbers, std::int64_t size, std::int64_t number) {
  return numerics::first_where(0, size, [&](std::int64_t at) {
    std::int64_t value = 0;
    numbers.read(at, 1, &value);
    return value >= number;
  });
}

/// Decodes the records of some rows from columns, [row][record], flattened.
/// @param skipped_rows rows in the columns before the first.
/// @param width number of records in a row.
template <class Record>
std::vector<Record> records_at(const std::vector<layout::RecordField<Record>>& fields,
                               const OutcomeColumns::Columns& columns, std::int64_t skipped_rows,
                               std::int64_t rows, std::int64_t width) {
  std::vector<Record> records(static_cast<std::size_t>(rows * width));
  layout::scatter_all(fields, columns, static_cast<std::size_t>(skipped_rows * width), std::span(records));
  return records;
}

constexpr std::int64_t moves_of_part = 1024;

/// Calls work(part) for successive parts of the positions, of `size` each, several at a time on several
/// threads. If several parts throw, the exception of the first of these parts is thrown, whichever ends
/// first.
template <class Work>
void for_each_part(layout::RowRange positions, std::int64_t size, const Work& work) {
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>((positions.count + size - 1) / size));
  const auto run = [&](std::size_t i) {
    const std::int64_t first = positions.first + static_cast<std::int64_t>(i) * size;
    try {
      work(layout::RowRange{first, std::min(size, positions.end() - first)});
    } catch (...) {
      failures[i] = std::current_exception();
    }
  };
  // A thread that waits here must not begin another task meanwhile.
  if (failures.size() == 1) {
    run(0);
  } else {
    oneapi::tbb::this_task_arena::isolate(
        [&] { oneapi::tbb::parallel_for(std::size_t{0}, failures.size(), run); });
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace

trial::ErrorBands read_bands(const hdf5::File& file) {
  const std::string scale = layout::band_dimension({}).scale.name;
  if (!file.contains(scale)) return {.count = 0};
  const hdf5::Dataset dataset = file.open_dataset(scale);
  const std::vector<hdf5::Size> extent = dataset.extent();
  trial::ErrorBands bands;
  if (dataset.element() != hdf5::Element::int64 || extent.size() != 1 || extent[0] > bands.limits.size())
    dataset.fail(fmt::format("it should be at most {} whole numbers", bands.limits.size()));
  bands.count = static_cast<std::size_t>(extent[0]);
  dataset.read(0, std::ssize(bands.values()), bands.limits.data());
  if (bands.count == 0 || bands.limits[0] < 0 ||
      !std::is_sorted(bands.values().begin(), bands.values().end(), std::less_equal()))
    dataset.fail("its numbers should rise from 0 or more");
  return bands;
}

trial::Tolerances read_tolerances(const hdf5::File& file) {
  const std::string scale = layout::tolerance_dimension({}).scale.name;
  if (!file.contains(scale)) return {};
  const hdf5::Dataset dataset = file.open_dataset(scale);
  const std::vector<hdf5::Size> extent = dataset.extent();
  trial::Tolerances tolerances;
  if (dataset.element() != hdf5::Element::float64 || extent.size() != 1 ||
      extent[0] > tolerances.limits.size())
    dataset.fail(fmt::format("it should be at most {} numbers", tolerances.limits.size()));
  tolerances.count = static_cast<std::size_t>(extent[0]);
  dataset.read(0, std::ssize(tolerances.values()), tolerances.limits.data());
  if (tolerances.count == 0 || !(tolerances.limits[0] > 0.0) ||
      !std::is_sorted(tolerances.values().begin(), tolerances.values().end(), std::less_equal()))
    dataset.fail("its numbers should rise from above 0");
  return tolerances;
}

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

TrialSource trials_in(const hdf5::File& file, const layout::MeasureTable& measures) {
  return {read_features(file, measures), read_input_columns(file.open_group("trial")), file.contains("trace"),
          [&file](const layout::Table& table) { return layout::TableReader::open(file, table); }};
}

TrialTables::TrialTables(const TrialSource& source, const layout::FileHeader& header,
                         const layout::MeasureTable* table)
    : features_(source.features),
      inputs_(source.inputs),
      trials_(source.open(layout::trial_table(inputs_))),
      table_(table != nullptr ? table : &layout::measure_table(features_)),
      measures_(layout::outcome_fields(features_, *table_)),
      move_fields_(layout::move_fields(features_, *table_)),
      outcomes_(source.open(layout::outcome_table(features_, *table_))),
      jerks_(source.open(layout::jerk_table())) {
  if (source.has_trace) trace_ = source.open(layout::trace_table(features_));
  if (!layout::has_sums(header.retention)) first_row_ = header.rows.first;
  if (first_row_ && trials_.rows() != header.rows.count)
    trials_.row_scale().fail("its size differs from the attribute 'trial_count'");
  if (features_.bands.count > 0) bands_ = source.open(layout::band_table(features_.bands));
  if (features_.tolerances.count > 0) tolerances_ = source.open(layout::tolerance_table(features_));
  if (outcomes_.rows() != trials_.rows() || (bands_ && bands_->rows() != trials_.rows()) ||
      (tolerances_ && tolerances_->rows() != trials_.rows()))
    outcomes_.row_scale().fail("its size differs from that of the trials");
  validate_numbering(header, trials_, jerks_);
}

std::vector<std::int64_t> TrialTables::rows(layout::RowRange positions) const {
  std::vector<std::int64_t> rows(static_cast<std::size_t>(positions.count));
  if (first_row_) {
    std::iota(rows.begin(), rows.end(), *first_row_ + positions.first);
  } else {
    trials_.row_scale().read(positions.first, positions.count, rows.data());
  }
  return rows;
}

layout::RowRange TrialTables::positions_of(layout::RowRange rows) const {
  if (first_row_) return {rows.first - *first_row_, rows.count};
  const std::int64_t first = first_not_below(trials_.row_scale(), trials_.rows(), rows.first);
  return {first, first_not_below(trials_.row_scale(), trials_.rows(), rows.end()) - first};
}

std::vector<double> TrialTables::input(std::size_t column, layout::RowRange positions) const {
  std::vector<double> values(static_cast<std::size_t>(positions.count));
  trials_.column(columns_before_inputs + column).read(positions.first, positions.count, values.data());
  return values;
}

std::vector<trial::MoveOutcome> TrialTables::outcomes(layout::RowRange positions) const {
  const std::int64_t chunk_rows = layout::chunk_rows(moves());
  const std::int64_t first = positions.first / chunk_rows * chunk_rows;
  const layout::RowRange chunk{first, std::min(chunk_rows, count() - first)};
  const bool is_small = positions.count <= chunk_rows / 2 && positions.end() <= chunk.end();
  if (!is_small) return outcomes(decoded(stored_outcomes(positions)), positions);
  if (!last_chunk_ || last_chunk_->positions != chunk) last_chunk_ = decoded(stored_outcomes(chunk));
  return outcomes(*last_chunk_, positions);
}

StoredOutcomes TrialTables::stored_outcomes(layout::RowRange positions) const {
  const auto fetched = [&](const layout::TableReader& io) {
    return layout::fetch_columns(io, positions.first, positions.count);
  };
  StoredOutcomes stored{positions, fetched(outcomes_), {}, {}};
  if (bands_) stored.bands = fetched(*bands_);
  if (tolerances_) stored.tolerances = fetched(*tolerances_);
  return stored;
}

OutcomeColumns TrialTables::decoded(const StoredOutcomes& stored) const {
  OutcomeColumns columns{stored.positions, layout::decode_columns(outcomes_, stored.moves), {}, {}};
  if (bands_) columns.bands = layout::decode_columns(*bands_, stored.bands);
  if (tolerances_) columns.tolerances = layout::decode_columns(*tolerances_, stored.tolerances);
  return columns;
}

std::vector<trial::MoveOutcome> TrialTables::outcomes(const OutcomeColumns& columns,
                                                      layout::RowRange positions) const {
  const std::int64_t width = outcomes_.width();
  std::vector<trial::MoveOutcome> moves(static_cast<std::size_t>(positions.count * width));
  for_each_part(positions, std::max<std::int64_t>(1, moves_of_part / width), [&](layout::RowRange part) {
    take_moves(columns, part,
               std::span(moves).subspan(static_cast<std::size_t>((part.first - positions.first) * width),
                                        static_cast<std::size_t>(part.count * width)));
  });
  return moves;
}

void TrialTables::take_moves(const OutcomeColumns& columns, layout::RowRange positions,
                             std::span<trial::MoveOutcome> moves) const {
  const std::int64_t width = outcomes_.width();
  layout::scatter_all(move_fields_, columns.moves,
                      static_cast<std::size_t>((positions.first - columns.positions.first) * width), moves);
  validate_outcomes(outcomes_, move_fields_, number_of(positions.first), moves);
  for (std::size_t i = 0; i < moves.size(); ++i) moves[i].number = static_cast<std::int64_t>(i) % width;
  if (bands_) take_bands(columns, positions, moves);
  if (tolerances_) take_tolerances(columns, positions, moves);
}

std::vector<std::int64_t> TrialTables::jerk_counts(const OutcomeColumns& columns,
                                                   layout::RowRange positions) const {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(positions.count), 0);
  const auto column = std::find_if(move_fields_.begin(), move_fields_.end(),
                                   [](const auto& field) { return field.column.name == "jerk_count"; });
  if (column == move_fields_.end()) return counts;
  const std::vector<std::byte>& bytes =
      columns.moves[static_cast<std::size_t>(column - move_fields_.begin())];
  const auto moves = static_cast<std::size_t>(outcomes_.width());
  std::size_t at =
      static_cast<std::size_t>(positions.first - columns.positions.first) * moves * sizeof(std::int64_t);
  for (std::int64_t& count : counts) {
    for (std::size_t move = 0; move < moves; ++move, at += sizeof(std::int64_t)) {
      std::int64_t of_move = 0;
      std::memcpy(&of_move, bytes.data() + at, sizeof of_move);
      count += of_move;
    }
  }
  return counts;
}

void TrialTables::take_bands(const OutcomeColumns& columns, layout::RowRange positions,
                             std::span<trial::MoveOutcome> moves) const {
  const std::vector<trial::BandOutcome> bands =
      records_at(layout::band_fields(), columns.bands, positions.first - columns.positions.first,
                 positions.count, bands_->width());
  validate_bands(*bands_, number_of(positions.first), bands);
  auto next = bands.begin();
  for (trial::MoveOutcome& move : moves) {
    const auto first = std::exchange(next, next + static_cast<std::ptrdiff_t>(features_.bands.count));
    std::copy(first, next, move.bands.begin());
  }
}

void TrialTables::take_tolerances(const OutcomeColumns& columns, layout::RowRange positions,
                                  std::span<trial::MoveOutcome> moves) const {
  const std::vector<layout::ToleranceRecord> records =
      records_at(layout::tolerance_fields(features_), columns.tolerances,
                 positions.first - columns.positions.first, positions.count, tolerances_->width());
  validate_tolerances(*tolerances_, layout::tolerance_fields(features_), number_of(positions.first), records);
  std::size_t next = 0;
  for (trial::MoveOutcome& move : moves)
    for (std::size_t i = 0; i < features_.tolerances.count; ++i, ++next) {
      move.tolerance_settling_times[i] = records[next].settling_time;
      if (features_.load_error || features_.motor_error)
        move.other_tolerance_settling_times[i] = records[next].other_settling_time;
    }
}

std::vector<double> TrialTables::measure(std::string_view name, layout::RowRange positions) const {
  const auto known = std::find_if(table_->begin(), table_->end(), [name](const layout::Measure& measure) {
    return measure.field.column.name == name;
  });
  if (known == table_->end())
    throw std::invalid_argument(fmt::format("'{}' is not a measure of a move", name));

  const layout::RecordField<trial::MoveOutcome>& field = known->field;
  const auto size = static_cast<std::size_t>(positions.count * outcomes_.width());
  const auto named = [name](const auto& one) { return one.column.name == name; };
  if (std::none_of(measures_.begin(), measures_.end(), named)) return std::vector<double>(size, 0.0);
  std::vector<trial::MoveOutcome> moves(size);
  if (layout::is_computed(field)) {
    moves = outcomes(positions);
  } else {
    std::vector<std::byte> bytes(size * hdf5::size_of(field.column.element));
    const auto column = std::find_if(move_fields_.begin(), move_fields_.end(), named);
    outcomes_.column(static_cast<std::size_t>(column - move_fields_.begin()))
        .read(positions.first, positions.count, bytes.data());
    layout::scatter(field, bytes, std::span(moves));
    validate_measure(outcomes_, move_fields_, name, number_of(positions.first), moves);
  }
  std::vector<double> values(size);
  std::transform(moves.begin(), moves.end(), values.begin(),
                 [&](const trial::MoveOutcome& move) { return layout::value_of(field, move); });
  return values;
}

std::vector<layout::JerkRecord> TrialTables::jerks_at(std::int64_t first, std::int64_t count) const {
  std::vector<layout::JerkRecord> jerks = layout::read_records(jerks_, layout::jerk_fields(), first, count);
  validate_jerks(jerks_, moves(), first, jerks);
  return jerks;
}

std::vector<layout::JerkRecord> TrialTables::jerks_of(layout::RowRange rows) const {
  const std::int64_t first = first_jerk_from(rows.first);
  return jerks_at(first, first_jerk_from(rows.end()) - first);
}

std::int64_t TrialTables::first_jerk_from(std::int64_t row) const {
  return first_not_below(jerks_.column(0), jerks_.rows(), row);
}

std::vector<layout::TraceRecord> TrialTables::trace_at(std::int64_t first, std::int64_t count) const {
  if (!trace_) return {};
  std::vector<layout::TraceRecord> records =
      layout::read_records(*trace_, layout::trace_fields(features_), first, count);
  for (layout::TraceRecord& record : records) {
    if (!features_.travel) record.reference = record.target;
    if (!features_.drive_torque) record.drive_torque = record.torque;
  }
  return records;
}

void TrialTables::for_each_block(const std::function<void(layout::RowRange positions)>& take) const {
  const std::int64_t size = layout::chunk_rows(moves());
  for (std::int64_t first = 0; first < count(); first += size) take({first, std::min(size, count() - first)});
}

void TrialTables::require_valid_values() const {
  std::int64_t jerks = 0;
  for_each_block([&](layout::RowRange block) {
    for (std::size_t column = 0; column < inputs_.size(); ++column) input(column, block);
    const std::vector<trial::MoveOutcome> of_block = outcomes(block);
    const std::int64_t counted = std::accumulate(
        of_block.begin(), of_block.end(), std::int64_t{0},
        [](std::int64_t sum, const trial::MoveOutcome& move) { return sum + move.jerk_count; });
    if (counted > jerk_count() - jerks) jerks_.column(0).fail("it has fewer jerks than the outcomes count");
    validate_jerk_counts(jerks_, rows(block), of_block, jerks_at(jerks, counted));
    jerks += counted;
  });
  if (jerks != jerk_count()) jerks_.column(0).fail("it has more jerks than the outcomes count");
  for (std::int64_t first = 0; first < trace_count(); first += layout::chunk_elements)
    trace_at(first, std::min(layout::chunk_elements, trace_count() - first));
}

}  // namespace zerocount::reading
