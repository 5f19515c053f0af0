#include "results/reading/all_trials_file.hpp"

#include <fmt/format.h>

#include "core/failure/failure.hpp"

namespace zerocount::reading {

AllTrialsFile::AllTrialsFile(const std::filesystem::path& path, Require require,
                             const layout::MeasureTable* table)
    : ResultsFile(path, require, table) {
  layout::require_every_trial(path, header());
}

/// The positions of the rows in the tables. @throws Failure if the file does not hold them
layout::RowRange AllTrialsFile::local(layout::RowRange range) const {
  if (range.first < rows().first || range.count < 0 || range.end() > rows().end()) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: trials {} to {} were asked for; it holds {} to {}", path().string(),
                              range.first, range.end() - 1, rows().first, rows().end() - 1));
  }
  return trials()->positions_of(range);
}

std::vector<double> AllTrialsFile::inputs_of(std::int64_t row) const {
  std::vector<double> values;
  for (std::size_t column = 0; column < input_columns().size(); ++column)
    values.push_back(input(column, {row, 1}).front());
  return values;
}

std::vector<layout::JerkRecord> AllTrialsFile::jerks(layout::RowRange range) const {
  local(range);
  return trials()->jerks_of(range);
}

}  // namespace zerocount::reading
