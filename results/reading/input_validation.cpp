#include "results/reading/input_validation.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "experiments/study/input_ranges.hpp"

namespace zerocount::reading {

void check_inputs(const TrialTables& trials, const study::Study& study, layout::RowRange positions,
                  const ReportInput& report) {
  const std::vector<study::InputColumn>& columns = trials.input_columns();
  const std::vector<study::InputRange> ranges = study::input_ranges(study);
  const std::vector<std::int64_t> rows = trials.rows(positions);
  for (std::size_t column = 0; column < std::min(ranges.size(), columns.size()); ++column) {
    const std::vector<double> values = trials.input(column, positions);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (study::contains(ranges[column], values[i])) continue;
      report(fmt::format("/trial/input/{}: trial {}: it is {}; expected {}", columns[column].name, rows[i],
                         values[i], numerics::range_text(ranges[column].range)));
    }
  }
}

}  // namespace zerocount::reading
