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

namespace zerocount::reading {

/// How much of its study a file must hold to be opened.
enum class Require {
  complete,   ///< every trial: what statistics may be made of
  any_part,   ///< also a part or a shard
  unfinished  ///< also a file that is still being made
};

/// A profile as it stands in a results file.
struct StoredProfile {
  std::string name;
  std::string unit;
  std::vector<double> theta;  ///< rad
  std::vector<double> value;  ///< in `unit`; of rigs [rig][theta], flattened
  std::int64_t rigs{0};       ///< each with a rotor of its own; 0: one rotor of all trials
};

/// The rigs of a study as they stand in a results file.
struct StoredRigs {
  std::int64_t rigs{0};
  std::vector<study::InputColumn> columns;  ///< what differs between them
  std::vector<std::vector<double>> inputs;  ///< [column][rig]
  std::vector<std::int64_t> success;        ///< [point][rig], flattened: trials that succeeded
  std::vector<std::int64_t> trials;         ///< likewise: trials that were judged; none of both in a part
};

/// A results file, open to be read. Rows are global rows, here and in the file. Every function may find that
/// the file is damaged, or holds values that cannot be (see validation.hpp), and throws Failure (bad_data)
/// then. One thread at a time.
class StudyFile {
 public:
  /// Checks checksum trailer, format, version, completion mark, completeness as required, and that the rows
  /// have the numbers of their places (see validation.hpp). Reads the file once from beginning to end.
  /// @throws ForeignFile for another format or a newer version; Failure: bad_input where there is no such
  /// file, machine_failed where it cannot be read, otherwise bad_data.
  /// @param table the measures that its moves may have; stays as long as this.
  explicit StudyFile(const std::filesystem::path& path, Require require = Require::complete,
                     const layout::MeasureTable& table = layout::measure_table());

  const std::filesystem::path& path() const { return path_; }
  const layout::FileHeader& header() const { return header_; }
  const hdf5::Group& root() const { return file_; }  ///< for groups that this class does not know
  layout::RowRange rows() const { return header_.rows; }
  /// Of a shard always rotary, whose units are those of the tables.
  parameters::AxisKind axis() const { return features_.axis; }
  std::int64_t moves() const { return outcomes_.width(); }

  /// Empty in a shard, like axes, statistics and their tables.
  std::vector<std::string> point_labels() const;
  std::vector<study::SweepAxis> axes() const;
  std::vector<layout::PointColumn> statistics() const;
  std::vector<layout::StatisticTable> statistic_tables() const;

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

  bool has_profiles() const { return file_.contains("profile"); }
  std::vector<StoredProfile> profiles() const;

  /// Nothing in a study without rigs, and in a shard.
  std::optional<StoredRigs> rigs() const;

 private:
  std::int64_t local(layout::RowRange rows) const;

  std::filesystem::path path_;
  hdf5::File file_;
  layout::FileHeader header_;
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
