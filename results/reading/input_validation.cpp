#include "results/reading/input_validation.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::reading {
namespace {

bool is_allowed(const parameters::Parameter& row, double value) {
  return numerics::contains(row.range, value) || (row.none && value == *row.none);
}

}  // namespace

void check_inputs(const TrialTables& trials, const study::Study& study, layout::RowRange positions,
                  const ReportInput& report) {
  const std::vector<study::InputColumn>& columns = trials.input_columns();
  if (study.plan == nullptr) return;  // a study that was not made from a manifest
  const std::vector<study::InputSource>& sources = study.plan->inputs;
  const std::vector<std::int64_t> rows = trials.rows(positions);
  for (std::size_t column = 0; column < std::min(sources.size(), columns.size()); ++column) {
    const std::vector<double> values = trials.input(column, positions);
    const parameters::Parameter& row = study.plan->table.rows[sources[column].slot];
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (is_allowed(row, values[i])) continue;
      report(fmt::format("/trial/input/{}: trial {}: it is {}; expected {}", columns[column].name, rows[i],
                         values[i], numerics::range_text(row.range)));
    }
  }
}

}  // namespace zerocount::reading
