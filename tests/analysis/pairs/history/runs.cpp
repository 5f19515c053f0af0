#include "tests/analysis/pairs/history/runs.hpp"

#include <cmath>

#include <fmt/format.h>

#include "analysis/basis/statistics/proportion.hpp"

namespace zerocount::testing {

history::RunRecord run_of_day(int day, double rate_a, double rate_b, double arrival_time) {
  history::RunRecord run{{"gains", "series", "study", fmt::format("file {}", day), std::to_string(day), 200,
                          "0.1.0", fmt::format("{:040x}", day),
                          fmt::format("2026-{:02}-{:02}T02:30:00Z", day / 28 + 1, day % 28 + 1)}};
  for (const auto& [point, rate] : {std::pair("a", rate_a), std::pair("b", rate_b)}) {
    run.values.push_back({point, "success_rate", "1", statistics::MeasurementKind::proportion, rate,
                          statistics::clopper_pearson(std::llround(200.0 * rate), 200), 200});
  }
  run.values.push_back({"a",
                        "arrival_time",
                        "s",
                        statistics::MeasurementKind::mean,
                        arrival_time,
                        {arrival_time - 0.001, arrival_time + 0.001},
                        190});
  return run;
}

void compare_with_baseline(history::RunRecord& run, double p) {
  run.comparison = history::RunComparison{"passed", "paired", "2025-12-31T00:00:00Z", std::string(40, 'b')};
  for (history::RunValue& value : run.values)
    value.comparison = history::ValueComparison{"equivalent", 0.5, 0.5 - value.value, {-0.01, 0.01}, 0.02, p};
}

}  // namespace zerocount::testing
