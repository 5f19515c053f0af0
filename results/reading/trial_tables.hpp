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

/// The columns of the outcomes of trials as they are stored.
struct StoredOutcomes {
  layout::RowRange positions;
  std::vector<hdf5::FetchedRows> moves, bands, tolerances;
};

/// The columns of the outcomes of trials, as the bytes of their elements.
struct OutcomeColumns {
  using Columns = std::vector<std::vector<std::byte>>;
  layout::RowRange positions;
  Columns moves, bands, tolerances;
};

/// Source of the tables of trials: a results file or a shard.
struct TrialSource {
  study::StudyFeatures features;  ///< Features that decide which columns the tables have
  std::vector<study::InputColumn> inputs;
  bool has_trace{false};
  std::function<layout::TableReader(const layout::Table&)> open;
};

/// The tables of trials in a results file.
/// @param file must live as long as the opened tables. @param measures measures that moves may have.
TrialSource trials_in(const hdf5::File& file, const layout::MeasureTable& measures);

/// The trials that a results file or a shard keeps: /trial, /outcome, /jerk and /trace. With `keep: failures`
/// they are the trials that did not succeed, otherwise every trial of the file.
///
/// Ranges named `positions` count the kept trials from 0, in order of rows; ranges named `rows` are global
/// rows. Every function may find that the file is damaged, and throws Failure (bad_data) then.
class TrialTables {
 public:
  /// Checks sizes and row numbers (see validation.hpp).
  /// @param table measures that moves may have; must live as long as this. Null: the measures of this program
  /// with the error bands of the source.
  TrialTables(const TrialSource& source, const layout::FileHeader& header, const layout::MeasureTable* table);

  std::int64_t count() const { return trials_.rows(); }
  std::vector<std::int64_t> rows(layout::RowRange positions) const;
  /// Positions of the kept trials among these rows
  layout::RowRange positions_of(layout::RowRange rows) const;

  /// Inputs of the trials. How often each is drawn is not in the file.
  const std::vector<study::InputColumn>& input_columns() const { return inputs_; }
  std::vector<double> input(std::size_t column, layout::RowRange positions) const;

  std::int64_t moves() const { return outcomes_.width(); }
  /// The measures that the file has.
  const std::vector<layout::RecordField<trial::MoveOutcome>>& measures() const { return measures_; }
  const layout::MeasureTable& table() const { return *table_; }
  /// All measures of the moves, [trial][move], flattened. Measures that the study does not use are 0 or
  /// false. Only one thread at a time may call it: it reads the file and keeps the last chunk.
  std::vector<trial::MoveOutcome> outcomes(layout::RowRange positions) const;
  /// The steps of outcomes(). Only stored_outcomes() calls the HDF5 library; any thread may take the other
  /// steps.
  StoredOutcomes stored_outcomes(layout::RowRange positions) const;
  OutcomeColumns decoded(const StoredOutcomes& stored) const;
  /// @param positions positions to return; the columns must contain them.
  std::vector<trial::MoveOutcome> outcomes(const OutcomeColumns& columns, layout::RowRange positions) const;
  /// Number of jerks that each trial counts, [trial]. The values are not checked as outcomes() checks them.
  std::vector<std::int64_t> jerk_counts(const OutcomeColumns& columns, layout::RowRange positions) const;
  /// One measure of the moves by its name, [trial][move], flattened, as doubles whatever its type in the
  /// file. 0 if the study does not use it.
  std::vector<double> measure(std::string_view name, layout::RowRange positions) const;

  std::int64_t jerk_count() const { return jerks_.rows(); }
  /// Some jerks, by position in the table of jerks.
  std::vector<layout::JerkRecord> jerks_at(std::int64_t first, std::int64_t count) const;
  std::vector<layout::JerkRecord> jerks_of(layout::RowRange rows) const;
  /// Position of the first jerk of a trial not before `row`: the table is ordered by trial.
  std::int64_t first_jerk_from(std::int64_t row) const;

  bool has_trace() const { return trace_.has_value(); }
  std::int64_t trace_count() const { return trace_ ? trace_->rows() : 0; }
  /// Some sample records, by position in their table. If a column is missing, `reference` is the target,
  /// `phase` is fine, and `drive_torque` is the torque decided, which reaches the motor after the delay of
  /// the control.
  std::vector<layout::TraceRecord> trace_at(std::int64_t first, std::int64_t count) const;

  /// Features that decide which columns of /outcome and /trace the file has, and the kind of axis.
  const study::StudyFeatures& features() const { return features_; }

  /// Calls `take(positions)` for blocks of trials that have about a chunk of moves each.
  void for_each_block(const std::function<void(layout::RowRange positions)>& take) const;
  /// Reads everything once, which checks the values, and checks that the outcomes count the jerks that are in
  /// the table.
  void require_valid_values() const;

 private:
  /// Copies the measures of the moves at these positions, and checks them.
  void take_moves(const OutcomeColumns& columns, layout::RowRange positions,
                  std::span<trial::MoveOutcome> moves) const;
  /// Copies the measures of the error bands at these positions into their moves, and checks them.
  void take_bands(const OutcomeColumns& columns, layout::RowRange positions,
                  std::span<trial::MoveOutcome> moves) const;
  void take_tolerances(const OutcomeColumns& columns, layout::RowRange positions,
                       std::span<trial::MoveOutcome> moves) const;
  /// Number of a trial in messages about values: its global row, or its position if only failures are kept.
  std::int64_t number_of(std::int64_t position) const { return first_row_.value_or(0) + position; }

  std::optional<std::int64_t> first_row_;  ///< Row of the first trial, if every trial is kept.
  study::StudyFeatures features_;
  std::vector<study::InputColumn> inputs_;
  layout::TableReader trials_;  ///< Columns: point, index, then one per input.
  const layout::MeasureTable* table_;
  std::vector<layout::RecordField<trial::MoveOutcome>> measures_;
  std::vector<layout::RecordField<trial::MoveOutcome>> move_fields_;  ///< Fields of the columns of outcomes_.
  layout::TableReader outcomes_;
  std::optional<layout::TableReader> bands_;  ///< Present if the file has error bands.
  /// Present if the file has tolerances of the position error.
  std::optional<layout::TableReader> tolerances_;
  layout::TableReader jerks_;
  std::optional<layout::TableReader> trace_;
  /// The chunk from which outcomes were read last. Small ranges of trials are usually read one after the
  /// other, so this saves reads of the same chunk.
  mutable std::optional<OutcomeColumns> last_chunk_;
};

/// The error bands of the file.
trial::ErrorBands read_bands(const hdf5::File& file);
/// The tolerances of the position error in the file; none if it has none.
trial::Tolerances read_tolerances(const hdf5::File& file);

/// The columns of the group `input` of /trial or /machine; empty without such a group.
std::vector<study::InputColumn> read_input_columns(const hdf5::Group& table);

}  // namespace zerocount::reading
