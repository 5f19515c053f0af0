#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/row_range.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/results_file.hpp"

namespace zerocount::reading {

/// A results file, open to be read. Rows are global rows, here and in the file. Every function may find that
/// the file is damaged, or holds values that cannot be (see validation.hpp), and throws Failure (bad_data)
/// then. One thread at a time.
class StudyFile : public ResultsFile {
 public:
  /// Checks checksum trailer, format, version, completion mark, completeness as required, and that the rows
  /// have the numbers of their places (see validation.hpp). Reads the file once from beginning to end.
  /// @throws ForeignFile for another format or a newer version; Failure: bad_input where there is no such
  /// file, machine_failed where it cannot be read, otherwise bad_data.
  /// @param table the measures that its moves may have; stays as long as this.
  explicit StudyFile(const std::filesystem::path& path, Require require = Require::complete,
                     const layout::MeasureTable& table = layout::measure_table());

  /// Of a shard always rotary, whose units are those of the tables.
  parameters::AxisKind axis() const { return features_.axis; }
  std::int64_t moves() const { return outcomes_.width(); }

  /// How often each is drawn is not in the file.
  const std::vector<study::InputColumn>& input_columns() const { return inputs_; }
  std::vector<double> input(std::size_t column, layout::RowRange rows) const;  ///< [row]
  std::vector<double> inputs_of(std::int64_t row) const;                       ///< [input column]

  /// The measures that the file has; one of an earlier version of the layout lacks some.
  const std::vector<layout::RecordField<trial::MoveOutcome>>& measures() const { return measures_; }
  const layout::MeasureTable& table() const { return *table_; }
  /// All measures of the moves of these trials: [row][move], flattened. Those that the file lacks are 0, or
  /// false, which is their true value in such files but for final_error; true_error is NaN.
  std::vector<trial::MoveOutcome> outcomes(layout::RowRange rows) const;
  /// One measure of a move by its name, [row][move], flattened, whatever its type in the file, as doubles.
  /// NaN where it is not known.
  std::vector<double> measure(std::string_view name, layout::RowRange rows) const;

  /// Reads all rows of all tables in blocks, for the checks that this makes of them: for a file that is kept
  /// without being used at once.
  void require_valid_values() const;

  std::int64_t jerk_count() const { return jerks_.rows(); }
  /// By position in the table.
  std::vector<layout::JerkRecord> jerks_at(std::int64_t first, std::int64_t count) const;
  std::vector<layout::JerkRecord> jerks(layout::RowRange rows) const;  ///< of these trials
  /// Position of the first jerk of a trial not before `row`: the table is ordered by trial.
  std::int64_t first_jerk_from(std::int64_t row) const;

  bool has_trace() const { return trace_.has_value(); }
  std::int64_t trace_count() const { return trace_ ? trace_->rows() : 0; }
  /// Only the features that decide which columns of /outcome and /trace it has, and the axis.
  const study::StudyFeatures& features() const { return features_; }
  /// By position in the table. Without its column, `reference` is the target, `phase` fine, and
  /// `drive_torque` the torque decided, which becomes the motor's after the control's delay.
  std::vector<layout::TraceRecord> trace_at(std::int64_t first, std::int64_t count) const;

 private:
  std::int64_t local(layout::RowRange rows) const;

  study::StudyFeatures features_;
  std::vector<study::InputColumn> inputs_;
  layout::TableIo trials_;  ///< point, index, then one column per input
  const layout::MeasureTable* table_;
  std::vector<layout::RecordField<trial::MoveOutcome>> measures_;
  layout::TableIo outcomes_;
  layout::TableIo jerks_;
  std::optional<layout::TableIo> trace_;
};

}  // namespace zerocount::reading
