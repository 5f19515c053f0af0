#include "results/reading/study_file.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/measure_table.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/trial_tables.hpp"
#include "results/reading/validation.hpp"

namespace zerocount::reading {
namespace {

std::optional<layout::TableIo> open_trace(const hdf5::File& file, const study::StudyFeatures& features) {
  if (!file.contains("trace")) return std::nullopt;
  return layout::TableIo::open(file, layout::trace_table(features));
}

}  // namespace

StudyFile::StudyFile(const std::filesystem::path& path, Require require, const layout::MeasureTable& table)
    : ResultsFile(path, require, layout::Contents::trials),
      features_(read_features(file(), table)),
      inputs_(read_input_columns(file().open_group("trial"))),
      trials_(layout::TableIo::open(file(), layout::trial_table(inputs_))),
      table_(&table),
      measures_(layout::outcome_fields(header().version, features_, table)),
      outcomes_(layout::TableIo::open(file(), layout::outcome_table(header().version, features_, table))),
      jerks_(layout::TableIo::open(file(), layout::jerk_table())),
      trace_(open_trace(file(), features_)) {
  if (trials_.rows() != rows().count)
    trials_.row_scale().fail("its size differs from the attribute 'trial_count'");
  if (outcomes_.rows() != rows().count)
    outcomes_.row_scale().fail("its size differs from the attribute 'trial_count'");
  validate_numbering(header(), trials_, jerks_);
}

std::int64_t StudyFile::local(layout::RowRange range) const {
  if (range.first < rows().first || range.count < 0 || range.end() > rows().end()) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: trials {} to {} were asked for; it holds {} to {}", path().string(),
                              range.first, range.end() - 1, rows().first, rows().end() - 1));
  }
  return range.first - rows().first;
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
  return first_not_below(jerks_.column(0), jerks_.rows(), row);
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

}  // namespace zerocount::reading
