#include "runners/verification/failure_checks.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/summary/summed_point.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/input_validation.hpp"

namespace zerocount::verification {
namespace {

/// [point, from the first of the file] Counts the failures, and checks their inputs.
std::vector<std::int64_t> count_failures(const reading::StatisticsFile& file, const study::Study& study,
                                         ProblemList& problems) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(file.points()), 0);
  const reading::KeptTrials& failures = *file.failures();
  const std::int64_t at_once = layout::chunk_rows(failures.moves());
  for (std::int64_t first = 0; first < failures.count(); first += at_once) {
    const std::int64_t count = std::min(at_once, failures.count() - first);
    reading::check_inputs(failures, study, first, count,
                          [&](std::string problem) { problems.add(std::move(problem)); });
    const std::vector<trial::MoveOutcome> moves = failures.outcomes(first, count);
    std::span<const trial::MoveOutcome> rest = moves;
    for (const std::int64_t row : failures.rows(first, count)) {
      if (trial::succeeded(rest.first(static_cast<std::size_t>(failures.moves()))))
        problems.add(fmt::format("trial {}: kept as a failure; all its moves ended at zero", row));
      rest = rest.subspan(static_cast<std::size_t>(failures.moves()));
      ++counts[static_cast<std::size_t>(row / file.header().trials - file.first_point())];
    }
  }
  return counts;
}

}  // namespace

void check_failures(CheckReport& report, const reading::StatisticsFile& file, const study::Study& study) {
  add_check(report, "values", [&](Check& check, ProblemList& problems) {
    std::vector<std::int64_t> expected;
    for (std::int64_t i = 0; i < file.points(); ++i)
      expected.push_back(summary::restored_point(file, study, file.first_point() + i).failures());
    if (!file.failures()) {
      check.detail = "sums";
      return;
    }
    file.failures()->require_valid_values();
    const std::vector<std::int64_t> counts = count_failures(file, study, problems);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] == expected[i]) continue;
      problems.add(fmt::format("design point {}: {} failures; expected the {} of its sums",
                               file.first_point() + static_cast<std::int64_t>(i), counts[i], expected[i]));
    }
    check.detail = fmt::format("sums and {} failures", file.failures()->count());
  });
}

}  // namespace zerocount::verification
