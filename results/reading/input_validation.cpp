#include "results/reading/input_validation.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "experiments/study/input_ranges.hpp"

namespace zerocount::reading {
namespace {

/// @param values_of gives the values of a column by its index, row_of the row of a value by its index
template <class Values, class Row>
void check_columns(const std::vector<study::InputColumn>& columns, const study::Study& study,
                   const Values& values_of, const Row& row_of, const ReportInput& report) {
  const std::vector<study::InputRange> ranges = study::input_ranges(study);
  for (std::size_t column = 0; column < std::min(ranges.size(), columns.size()); ++column) {
    const std::vector<double> values = values_of(column);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (study::contains(ranges[column], values[i])) continue;
      report(fmt::format("/trial/input/{}: trial {}: it is {}; expected {}", columns[column].name, row_of(i),
                         values[i], numerics::range_text(ranges[column].range)));
    }
  }
}

}  // namespace

void check_inputs(const StudyFile& file, const study::Study& study, layout::RowRange rows,
                  const ReportInput& report) {
  check_columns(
      file.input_columns(), study, [&](std::size_t column) { return file.input(column, rows); },
      [&](std::size_t i) { return rows.first + static_cast<std::int64_t>(i); }, report);
}

void check_inputs(const KeptTrials& failures, const study::Study& study, std::int64_t first,
                  std::int64_t count, const ReportInput& report) {
  const std::vector<std::int64_t> rows = failures.rows(first, count);
  check_columns(
      failures.input_columns(), study,
      [&](std::size_t column) { return failures.input(column, first, count); },
      [&](std::size_t i) { return rows[i]; }, report);
}

}  // namespace zerocount::reading
