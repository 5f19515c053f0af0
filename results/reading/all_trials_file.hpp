#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/results_file.hpp"

namespace zerocount::reading {

/// A results file that keeps every trial, open to be read. Rows are global rows, here and in the file. Every
/// function may find that the file is damaged, or holds impossible values (see validation.hpp), and throws
/// Failure (bad_data) then; what the functions return is described at TrialTables. One thread at a time.
class AllTrialsFile : public ResultsFile {
 public:
  /// @throws as ResultsFile does, and ForeignFile for a file that does not keep every trial
  explicit AllTrialsFile(const std::filesystem::path& path, Require require = Require::complete,
                         const layout::MeasureTable* table = nullptr);

  parameters::AxisKind axis() const { return features().axis; }
  std::int64_t moves() const { return trials()->moves(); }

  const std::vector<study::InputColumn>& input_columns() const { return trials()->input_columns(); }
  std::vector<double> input(std::size_t column, layout::RowRange rows) const {  ///< [row]
    return trials()->input(column, local(rows));
  }
  std::vector<double> inputs_of(std::int64_t row) const;  ///< [input column]

  const std::vector<layout::RecordField<trial::MoveOutcome>>& measures() const {
    return trials()->measures();
  }
  const layout::MeasureTable& table() const { return trials()->table(); }
  std::vector<trial::MoveOutcome> outcomes(layout::RowRange rows) const {
    return trials()->outcomes(local(rows));
  }
  std::vector<double> measure(std::string_view name, layout::RowRange rows) const {
    return trials()->measure(name, local(rows));
  }

  void require_valid_values() const { trials()->require_valid_values(); }

  std::int64_t jerk_count() const { return trials()->jerk_count(); }
  std::vector<layout::JerkRecord> jerks_at(std::int64_t first, std::int64_t count) const {
    return trials()->jerks_at(first, count);
  }
  std::vector<layout::JerkRecord> jerks(layout::RowRange rows) const;
  std::int64_t first_jerk_from(std::int64_t row) const { return trials()->first_jerk_from(row); }

  bool has_trace() const { return trials()->has_trace(); }
  std::int64_t trace_count() const { return trials()->trace_count(); }
  const study::StudyFeatures& features() const { return trials()->features(); }
  std::vector<layout::TraceRecord> trace_at(std::int64_t first, std::int64_t count) const {
    return trials()->trace_at(first, count);
  }

 private:
  layout::RowRange local(layout::RowRange rows) const;
};

}  // namespace zerocount::reading
