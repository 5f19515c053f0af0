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

/// The bytes of their elements.
struct OutcomeColumns {
  using Columns = std::vector<std::vector<std::byte>>;
  layout::RowRange positions;
  Columns moves, bands, tolerances;
};

/// Where the tables of trials are: in a results file, or in a shard.
struct TrialSource {
  study::StudyFeatures features;  ///< those that decide which columns the tables have
  std::vector<study::InputColumn> inputs;
  bool has_trace{false};
  std::function<layout::TableReader(const layout::Table&)> open;
};

/// @param file stays as long as what is opened @param measures those that moves may have
TrialSource trials_in(const hdf5::File& file, const layout::MeasureTable& measures);

/// The trials that a results file or a shard keeps: /trial, /outcome, /jerk and /trace. With `keep: failures`
/// they are the trials that did not succeed, otherwise every trial of the file.
///
/// Ranges named `positions` count the kept trials from 0, in order of rows; ranges named `rows` are global
/// rows. Every function may find that the file is damaged, and throws Failure (bad_data) then.
class TrialTables {
 public:
  /// Checks sizes and row numbers (see validation.hpp).
  /// @param table the measures that moves may have, which stay as long as this; null: those of this program
  /// with the error bands of the source
  TrialTables(const TrialSource& source, const layout::FileHeader& header, const layout::MeasureTable* table);

  std::int64_t count() const { return trials_.rows(); }
  std::vector<std::int64_t> rows(layout::RowRange positions) const;
  layout::RowRange positions_of(layout::RowRange rows) const;  ///< of the kept trials among these

  /// How often each is drawn is not in the file.
  const std::vector<study::InputColumn>& input_columns() const { return inputs_; }
  std::vector<double> input(std::size_t column, layout::RowRange positions) const;

  std::int64_t moves() const { return outcomes_.width(); }
  /// The measures that the file has.
  const std::vector<layout::RecordField<trial::MoveOutcome>>& measures() const { return measures_; }
  const layout::MeasureTable& table() const { return *table_; }
  /// All measures of the moves, [trial][move], flattened. Those that the study has no use for are 0, or
  /// false.
  std::vector<trial::MoveOutcome> outcomes(layout::RowRange positions) const;
  /// The steps of outcomes(), of which only the first calls the library: the others are for any thread.
  StoredOutcomes stored_outcomes(layout::RowRange positions) const;
  OutcomeColumns decoded(const StoredOutcomes& stored) const;
  /// @param positions among those of the columns
  std::vector<trial::MoveOutcome> outcomes(const OutcomeColumns& columns, layout::RowRange positions) const;
  /// The jerks that each trial counts, [trial]. They may be impossible, as outcomes() would find.
  std::vector<std::int64_t> jerk_counts(const OutcomeColumns& columns, layout::RowRange positions) const;
  /// One measure of a move by its name, [trial][move], flattened, whatever its type in the file, as doubles.
  /// 0 if the study has no use for it.
  std::vector<double> measure(std::string_view name, layout::RowRange positions) const;

  std::int64_t jerk_count() const { return jerks_.rows(); }
  /// By position in the table of jerks.
  std::vector<layout::JerkRecord> jerks_at(std::int64_t first, std::int64_t count) const;
  std::vector<layout::JerkRecord> jerks_of(layout::RowRange rows) const;
  /// Position of the first jerk of a trial not before `row`: the table is ordered by trial.
  std::int64_t first_jerk_from(std::int64_t row) const;

  bool has_trace() const { return trace_.has_value(); }
  std::int64_t trace_count() const { return trace_ ? trace_->rows() : 0; }
  /// By position in the table of sample records. Without its column, `reference` is the target, `phase` fine,
  /// and `drive_torque` the torque decided, which becomes the motor's after the control's delay.
  std::vector<layout::TraceRecord> trace_at(std::int64_t first, std::int64_t count) const;

  /// Those that decide which columns of /outcome and /trace the file has, and the axis.
  const study::StudyFeatures& features() const { return features_; }

  /// Calls `take(positions)` for blocks of trials that have about a chunk of moves each.
  void for_each_block(const std::function<void(layout::RowRange positions)>& take) const;
  /// Reads everything once, for the checks that this makes, and checks that the jerks are those that the
  /// outcomes count.
  void require_valid_values() const;

 private:
  /// Takes the measures of the moves at these positions, and checks them.
  void take_moves(const OutcomeColumns& columns, layout::RowRange positions,
                  std::span<trial::MoveOutcome> moves) const;
  /// Takes the measures of the error bands of the trials at these positions into their moves.
  void take_bands(const OutcomeColumns& columns, layout::RowRange positions,
                  std::span<trial::MoveOutcome> moves) const;
  void take_tolerances(const OutcomeColumns& columns, layout::RowRange positions,
                       std::span<trial::MoveOutcome> moves) const;
  /// In messages about values: a global row, or a position where failures are kept.
  std::int64_t number_of(std::int64_t position) const { return first_row_.value_or(0) + position; }

  std::optional<std::int64_t> first_row_;  ///< if every trial is kept
  study::StudyFeatures features_;
  std::vector<study::InputColumn> inputs_;
  layout::TableReader trials_;  ///< point, index, then one column per input
  const layout::MeasureTable* table_;
  std::vector<layout::RecordField<trial::MoveOutcome>> measures_;
  std::vector<layout::RecordField<trial::MoveOutcome>> move_fields_;  ///< the columns of outcomes_
  layout::TableReader outcomes_;
  std::optional<layout::TableReader> bands_;       ///< if the file has error bands
  std::optional<layout::TableReader> tolerances_;  ///< if the file has error tolerances
  layout::TableReader jerks_;
  std::optional<layout::TableReader> trace_;
};

/// The error bands of the file.
trial::ErrorBands read_bands(const hdf5::File& file);
/// The tolerances of the file; none if it has none.
trial::Tolerances read_tolerances(const hdf5::File& file);

/// The columns of the group `input` of /trial or /machine; none without such a group.
std::vector<study::InputColumn> read_input_columns(const hdf5::Group& table);

}  // namespace zerocount::reading
