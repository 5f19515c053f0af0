#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/point_sums.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/results_file.hpp"

namespace zerocount::reading {

/// The trials that a study with `keep: failures` keeps: those that did not succeed, in order of rows. Every
/// function may find that the file is damaged, and throws Failure (bad_data) then.
class KeptTrials {
 public:
  /// @param file stays open as long as this
  KeptTrials(const hdf5::File& file, const layout::FileHeader& header);

  std::int64_t count() const { return trials_.rows(); }
  std::vector<std::int64_t> rows(std::int64_t first, std::int64_t count) const;  ///< global, by position
  /// Positions of the trials that are kept of these.
  layout::RowRange positions_of(layout::RowRange rows) const;

  const std::vector<study::InputColumn>& input_columns() const { return inputs_; }
  std::vector<double> input(std::size_t column, std::int64_t first, std::int64_t count) const;
  std::int64_t moves() const { return outcomes_.width(); }
  const std::vector<layout::RecordField<trial::MoveOutcome>>& measures() const { return measures_; }
  std::vector<trial::MoveOutcome> outcomes(std::int64_t first, std::int64_t count) const;
  std::int64_t jerk_count() const { return jerks_.rows(); }
  std::vector<layout::JerkRecord> jerks_at(std::int64_t first, std::int64_t count) const;
  std::vector<layout::JerkRecord> jerks_of(layout::RowRange rows) const;
  parameters::AxisKind axis() const { return features_.axis; }
  void require_valid_values() const;  ///< reads everything once

 private:
  void require_jerks_of(std::span<const std::int64_t> rows, std::span<const trial::MoveOutcome> outcomes,
                        std::span<const layout::JerkRecord> jerks) const;

  std::vector<study::InputColumn> inputs_;
  study::StudyFeatures features_;
  layout::TableIo trials_;
  std::vector<layout::RecordField<trial::MoveOutcome>> measures_;
  layout::TableIo outcomes_;
  layout::TableIo jerks_;
};

/// A results file of a study that keeps statistics in place of its trials (`keep`), open to be read.
class StatisticsFile : public ResultsFile {
 public:
  /// Reads the file once from beginning to end.
  /// @throws ForeignFile for another format or a newer version; Failure: bad_input where there is no such
  /// file, machine_failed where it cannot be read, otherwise bad_data.
  explicit StatisticsFile(const std::filesystem::path& path, Require require = Require::complete);

  /// The point of the first trial. The others follow it.
  std::int64_t first_point() const { return rows().first / header().trials; }
  std::int64_t points() const { return std::ssize(ends_); }
  layout::RowRange rows_of(std::int64_t point) const;  ///< those in the file
  /// @param index of the point, from first_point() on
  layout::PointSums sums(std::int64_t index) const;

  /// Nothing unless the study keeps them.
  const std::optional<KeptTrials>& failures() const { return failures_; }

 private:
  struct Ends {
    std::int64_t whole;
    std::int64_t real;
  };
  layout::TableIo whole_;
  layout::TableIo real_;
  std::optional<KeptTrials> failures_;
  std::vector<Ends> ends_;  ///< [point] after the last of its numbers
};

}  // namespace zerocount::reading
