#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "core/trial/outcome.hpp"
#include "experiments/study/features.hpp"
#include "experiments/study/grouping.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::reading {

/// The columns of the measures of some trials as the file stores them, not decoded yet.
struct StoredOutcomes {
  layout::RowRange positions;
  std::vector<hdf5::FetchedRows> moves, bands, tolerances;
};

/// The columns of the measures of some trials, decoded to the bytes of their elements.
struct OutcomeColumns {
  using Columns = std::vector<std::vector<std::byte>>;
  layout::RowRange positions;
  Columns moves, bands, tolerances;
};

/// Access to the tables of trials of a results file or a shard.
struct TrialSource {
  study::StudyFeatures features;  ///< Features that decide which columns the tables have
  std::vector<study::InputColumn> inputs;
  bool has_trace{false};
  std::function<layout::TableReader(const layout::Table&)> open;
};

/// Access to the tables of trials in a results file.
/// @param file must live as long as the opened tables.
/// @param measures measures that moves may have.
TrialSource trials_in(const hdf5::File& file, const layout::MeasureTable& measures);

/// The trials that a results file or a shard keeps: /trial, /outcome, /jerk and /trace. With `keep: failures`
/// they are the trials that did not succeed, otherwise every trial of the file.
///
/// Ranges named `positions` count the kept trials from 0, in order of rows; ranges named `rows` are global
/// rows. Every function may find that the file is damaged, and throws Failure (bad_data) then.
class TrialTables {
 public:
  /// Opens the tables, and checks sizes and row numbers (see validation.hpp).
  /// @param table measures that moves may have; must live as long as this object. Null: the measures of this
  /// program with the error bands of the source.
  TrialTables(const TrialSource& source, const layout::FileHeader& header, const layout::MeasureTable* table);

  std::int64_t count() const { return trials_.rows(); }
  std::vector<std::int64_t> rows(layout::RowRange positions) const;
  /// Range of positions (0, 1, … among the kept trials) of the kept trials whose global rows lie in `rows`
  layout::RowRange positions_of(layout::RowRange rows) const;

  /// The input parameters whose values the file has for each trial. The file does not say how often each is
  /// drawn.
  const std::vector<study::InputColumn>& input_columns() const { return inputs_; }
  std::vector<double> input(std::size_t column, layout::RowRange positions) const;

  std::int64_t moves() const { return outcomes_.width(); }
  /// Descriptions of the measures of a move that the file has.
  const std::vector<layout::RecordField<trial::MoveOutcome>>& measures() const { return measures_; }
  const layout::MeasureTable& table() const { return *table_; }
  /// All measures of the moves of the trials at `positions`, [trial][move], flattened. Measures that the
  /// study does not use are 0 or false. Only one thread at a time may call this function, because it reads
  /// the file and keeps the last chunk.
  std::vector<trial::MoveOutcome> outcomes(layout::RowRange positions) const;
  /// First step of outcomes(): finds the stored columns of the trials' measures. Only this step calls the
  /// HDF5 library; any thread may take the other steps.
  StoredOutcomes stored_outcomes(layout::RowRange positions) const;
  OutcomeColumns decoded(const StoredOutcomes& stored) const;
  /// Last step of outcomes(): the measures of all moves, [trial][move], flattened, from decoded columns.
  /// @param positions positions to return; the columns must contain them.
  std::vector<trial::MoveOutcome> outcomes(const OutcomeColumns& columns, layout::RowRange positions) const;
  /// Number of jerks that the outcomes of each trial count, [trial]. The values are not checked as outcomes()
  /// checks them.
  std::vector<std::int64_t> jerk_counts(const OutcomeColumns& columns, layout::RowRange positions) const;
  /// One measure of the moves by its name, [trial][move], flattened, as doubles whatever its type in the
  /// file. 0 if the study does not use it.
  std::vector<double> measure(std::string_view name, layout::RowRange positions) const;

  std::int64_t jerk_count() const { return jerks_.rows(); }
  /// The jerks at the positions [first, first + count) of the table of jerks.
  std::vector<layout::JerkRecord> jerks_at(std::int64_t first, std::int64_t count) const;
  std::vector<layout::JerkRecord> jerks_of(layout::RowRange rows) const;
  /// Position, in the table of jerks, of the first jerk whose trial has the global row `row` or a later one.
  /// The table is ordered by trial.
  std::int64_t first_jerk_from(std::int64_t row) const;

  bool has_trace() const { return trace_.has_value(); }
  std::int64_t trace_count() const { return trace_ ? trace_->rows() : 0; }
  /// The sample records at the positions [first, first + count) of the table /trace. If a column is missing,
  /// `reference` is the target, `phase` is fine, and `drive_torque` is the torque decided, which reaches the
  /// motor after the delay of the control.
  std::vector<layout::TraceRecord> trace_at(std::int64_t first, std::int64_t count) const;

  /// Features that decide which columns of /outcome and /trace the file has, and the kind of axis.
  const study::StudyFeatures& features() const { return features_; }

  /// Calls `take(positions)` for successive ranges of trials, each with about as many moves as a stored chunk
  /// has.
  void for_each_block(const std::function<void(layout::RowRange positions)>& take) const;
  /// Reads all tables once, which checks their values, and checks that the outcomes count exactly the jerks
  /// in the table of jerks.
  void require_valid_values() const;

 private:
  /// Copies the measures of the moves of the trials at these positions from decoded columns to `moves`, and
  /// checks them.
  void take_moves(const OutcomeColumns& columns, layout::RowRange positions,
                  std::span<trial::MoveOutcome> moves) const;
  /// Copies the measures of the error bands of the trials at these positions from decoded columns into their
  /// moves, and checks them.
  void take_bands(const OutcomeColumns& columns, layout::RowRange positions,
                  std::span<trial::MoveOutcome> moves) const;
  void take_tolerances(const OutcomeColumns& columns, layout::RowRange positions,
                       std::span<trial::MoveOutcome> moves) const;
  /// Number of a trial in messages about values: its global row, or its position if only failures are kept.
  std::int64_t number_of(std::int64_t position) const { return first_row_.value_or(0) + position; }

  std::optional<std::int64_t> first_row_;  ///< Global row of the first trial, if every trial is kept;
                                           /// < otherwise empty
  study::StudyFeatures features_;
  std::vector<study::InputColumn> inputs_;
  layout::TableReader trials_;  ///< Columns: point, index, then one per input.
  const layout::MeasureTable* table_;
  std::vector<layout::RecordField<trial::MoveOutcome>> measures_;
  /// Descriptions of the columns of outcomes_
  std::vector<layout::RecordField<trial::MoveOutcome>> move_fields_;
  layout::TableReader outcomes_;
  std::optional<layout::TableReader> bands_;  ///< Table of the measures of error bands; empty if the file has
                                              /// < none
  /// Table of the settling times for tolerances of the position error; empty if the file has none
  std::optional<layout::TableReader> tolerances_;
  layout::TableReader jerks_;
  std::optional<layout::TableReader> trace_;
  /// The decoded rows from which outcomes() read last. Small ranges of trials are usually read one after the
  /// other, so this saves decoding the same chunk again.
  mutable std::optional<OutcomeColumns> last_chunk_;
};

/// Reads the error bands of a results file.
trial::ErrorBands read_bands(const hdf5::File& file);
/// Reads the tolerances of the position error of a results file; none if it has none.
trial::Tolerances read_tolerances(const hdf5::File& file);

/// Reads which input parameters have columns in the group `input` of the table /trial or /machine; empty
/// without such a group.
std::vector<study::InputColumn> read_input_columns(const hdf5::Group& table);

}  // namespace zerocount::reading
