#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/reading/results_file.hpp"

namespace zerocount::reading {

/// A results file that keeps every trial, open to be read. Trials are identified by their global row,
/// point·trials + index. Every function throws Failure (bad_data) if it finds that the file is damaged or
/// holds impossible values (see validation.hpp). The functions' results are described at TrialTables. Only
/// one thread may use an object at a time.
class AllTrialsFile : public ResultsFile {
 public:
  /// Opens the file at `path`.
  /// @throws as ResultsFile does, and ForeignFile for a file that does not keep every trial.
  explicit AllTrialsFile(const std::filesystem::path& path, Require require = Require::complete,
                         const layout::MeasureTable* table = nullptr, const study::Study* study = nullptr);

  /// The trials in one setting (a condition at an age), shown as the file of a study of its own
  /// (study::in_setting()): all that is read of trials, and header().trials and rows(), belong to that study,
  /// whose row is point·trials + draw. What the file has of its design points, machines and traces stays that
  /// of all settings. A file without settings is shown as it is.
  AllTrialsFile in_setting(std::int64_t setting) const;

  parameters::AxisKind axis() const { return features().axis; }
  std::int64_t moves() const { return trials()->moves(); }

  const std::vector<study::InputColumn>& input_columns() const { return trials()->input_columns(); }
  /// Values of one input parameter of the trials in `rows`, [row]
  std::vector<double> input(std::size_t column, layout::RowRange rows) const;

  const std::vector<layout::RecordField<trial::MoveOutcome>>& measures() const {
    return trials()->measures();
  }
  const layout::MeasureTable& table() const { return trials()->table(); }
  std::vector<trial::MoveOutcome> outcomes(layout::RowRange rows) const;
  std::vector<double> measure(std::string_view name, layout::RowRange rows) const;

  /// First step of outcomes(): finds the stored columns of the trials' outcomes. Only this step calls the
  /// HDF5 library; any thread may take the other steps.
  StoredOutcomes stored_outcomes(layout::RowRange rows) const;
  OutcomeColumns decoded(const StoredOutcomes& stored) const { return trials()->decoded(stored); }
  /// Last step of outcomes(): the measures of all moves, [row][move], flattened, from decoded columns.
  /// @param rows rows to return; the columns must contain them.
  std::vector<trial::MoveOutcome> outcomes(const OutcomeColumns& columns, layout::RowRange rows) const;
  std::vector<std::int64_t> jerk_counts(const OutcomeColumns& columns, layout::RowRange rows) const;

  void require_valid_values() const { trials()->require_valid_values(); }

  /// Number of jerks in the table of jerks, for all settings (conditions at an age) together
  std::int64_t jerk_count() const { return trials()->jerk_count(); }
  /// The jerks at the positions [first, first + count) of the table of jerks. If the file is shown in one
  /// setting (a condition at an age), only the jerks of its trials among them are returned.
  std::vector<layout::JerkRecord> jerks_at(std::int64_t first, std::int64_t count) const;
  std::vector<layout::JerkRecord> jerks(layout::RowRange rows) const;
  std::int64_t first_jerk_from(std::int64_t row) const { return trials()->first_jerk_from(row_in_file(row)); }

  bool has_trace() const { return trials()->has_trace(); }
  std::int64_t trace_count() const { return trials()->trace_count(); }
  const study::StudyFeatures& features() const { return trials()->features(); }
  std::vector<layout::TraceRecord> trace_at(std::int64_t first, std::int64_t count) const {
    return trials()->trace_at(first, count);
  }

 private:
  /// The setting (a condition at an age) whose trials are read, if the file is shown in one setting.
  struct OneSetting {
    study::TrialIndices indices;
    std::int64_t number{0};
    std::int64_t trials{0};  ///< Number of trials of a design point, all settings together
  };

  AllTrialsFile(const AllTrialsFile& whole, std::int64_t setting);
  /// Row in the whole file of a trial in the setting (condition at an age) that is read.
  /// @param row row of the trial in the study of that setting alone.
  std::int64_t row_in_file(std::int64_t row) const;
  void require_rows(layout::RowRange rows) const;
  /// Range of positions in the file's tables from the first to the last trial in `rows`.
  layout::RowRange local(layout::RowRange rows) const;
  /// Selects the values that belong to `rows` from the values read for local(rows).
  /// @param width number of values of one trial.
  template <class Value>
  std::vector<Value> chosen(layout::RowRange rows, std::vector<Value> read, std::int64_t width) const;

  std::optional<OneSetting> setting_{};
};

/// Calls take(file, name) for the trials in each setting (a condition at an age) in turn. For a file without
/// settings it is called once, with the file itself and an empty name.
template <class Take>
void for_each_setting(const AllTrialsFile& file, const Take& take) {
  const study::Settings settings = file.study().settings;
  if (settings.empty()) return take(file, std::string());
  for (std::int64_t i = 0; i < settings.total(); ++i) take(file.in_setting(i), study::label_of(settings, i));
}

}  // namespace zerocount::reading
