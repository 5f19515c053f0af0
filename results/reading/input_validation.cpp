#include "results/reading/input_validation.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "experiments/study/input_ranges.hpp"

namespace zerocount::reading {

void check_inputs(const StudyFile& file, const study::Study& study, layout::RowRange rows,
                  const std::function<void(std::string problem)>& report) {
  const std::vector<study::InputRange> ranges = study::input_ranges(study);
  for (std::size_t column = 0; column < std::min(ranges.size(), file.input_columns().size()); ++column) {
    const std::vector<double> values = file.input(column, rows);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (study::contains(ranges[column], values[i])) continue;
      report(fmt::format("/trial/input/{}: trial {}: it is {}; expected {}",
                         file.input_columns()[column].name, rows.first + static_cast<std::int64_t>(i),
                         values[i], numerics::range_text(ranges[column].range)));
    }
  }
}

}  // namespace zerocount::reading
