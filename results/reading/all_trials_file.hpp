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

/// A results file that keeps every trial, open to be read. Rows are global rows, here and in the file. Every
/// function may find that the file is damaged, or holds impossible values (see validation.hpp), and throws
/// Failure (bad_data) then; what the functions return is described at TrialTables. One thread at a time.
class AllTrialsFile : public ResultsFile {
 public:
  /// Opens the file.
  /// @throws as ResultsFile does, and ForeignFile for a file that does not keep every trial.
  explicit AllTrialsFile(const std::filesystem::path& path, Require require = Require::complete,
                         const layout::MeasureTable* table = nullptr, const study::Study* study = nullptr);

  /// The trials in one setting, as the file of a study of its own (study::in_setting): all that is
  /// read of trials, and header().trials and rows(), are of that study, whose row is point·trials + draw.
  /// What the file has of its design points, machines and traces stays that of all settings. A file without
  /// settings is shown as it is.
  AllTrialsFile in_setting(std::int64_t setting) const;

  parameters::AxisKind axis() const { return features().axis; }
  std::int64_t moves() const { return trials()->moves(); }

  const std::vector<study::InputColumn>& input_columns() const { return trials()->input_columns(); }
  std::vector<double> input(std::size_t column, layout::RowRange rows) const;  ///< Values of an input, [row]

  const std::vector<layout::RecordField<trial::MoveOutcome>>& measures() const {
    return trials()->measures();
  }
  const layout::MeasureTable& table() const { return trials()->table(); }
  std::vector<trial::MoveOutcome> outcomes(layout::RowRange rows) const;
  std::vector<double> measure(std::string_view name, layout::RowRange rows) const;

  /// The steps of outcomes(). Only stored_outcomes() calls the HDF5 library; any thread may take the other
  /// steps.
  StoredOutcomes stored_outcomes(layout::RowRange rows) const;
  OutcomeColumns decoded(const StoredOutcomes& stored) const { return trials()->decoded(stored); }
  /// @param rows rows to return; the columns must contain them.
  std::vector<trial::MoveOutcome> outcomes(const OutcomeColumns& columns, layout::RowRange rows) const;
  std::vector<std::int64_t> jerk_counts(const OutcomeColumns& columns, layout::RowRange rows) const;

  void require_valid_values() const { trials()->require_valid_values(); }

  std::int64_t jerk_count() const { return trials()->jerk_count(); }  ///< Number of jerks of all settings
  /// The jerks at these positions of the table. In a setting, only the jerks of its trials among them
  /// are returned.
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
  /// The setting whose trials are read.
  struct OneSetting {
    study::TrialIndices indices;
    std::int64_t number{0};
    std::int64_t trials{0};  ///< Trials of a design point, of all settings together
  };

  AllTrialsFile(const AllTrialsFile& whole, std::int64_t setting);
  /// Index of the row in the whole file. @param row index among the trials of the setting that is read
  std::int64_t row_in_file(std::int64_t row) const;
  void require_rows(layout::RowRange rows) const;
  /// The positions in the tables from the first to the last of `rows`.
  layout::RowRange local(layout::RowRange rows) const;
  /// Selects the values of `rows` from values read from local(rows). @param width number of values of a
  /// trial.
  template <class Value>
  std::vector<Value> chosen(layout::RowRange rows, std::vector<Value> read, std::int64_t width) const;

  std::optional<OneSetting> setting_{};
};

/// Calls take(file, name) for the trials in each setting in turn; without settings for the file
/// itself, with an empty name.
template <class Take>
void for_each_setting(const AllTrialsFile& file, const Take& take) {
  const study::Settings settings = file.study().settings;
  if (settings.empty()) return take(file, std::string());
  for (std::int64_t i = 0; i < settings.total(); ++i) take(file.in_setting(i), study::label_of(settings, i));
}

}  // namespace zerocount::reading
