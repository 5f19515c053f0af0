#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/goal/question.hpp"
#include "analysis/measures/point_statistics.hpp"
#include "analysis/statistics/clusters/observed_test.hpp"
#include "analysis/text/report_field.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"

/// Counts on a real machine against the simulated trials of the same design point.
namespace zerocount::summary {

/// The comparison at a point: by fisher_test, or with machines by machine_rank_test, because the observed
/// trials are all of one machine. A trial succeeds if it does what the study asks (goal::Question): all its
/// moves meet the goals that are about them or, without a goal, end at zero counts.
struct ObservedComparison {
  study::ObservedCounts counts;
  statistics::Successes simulated{};             ///< trials of the point, with worlds of all together
  std::optional<statistics::ObservedTest> test;  ///< empty if the counts cannot be tested
  std::string reason;                            ///< why not
  bool in_worlds{false};                         ///< with the world that is most like the real machine
};

ObservedComparison compare_observed(const goal::Question& question, const measures::PointSummary& point,
                                    const study::ObservedCounts& counts);

/// The words of verdict_on().
inline constexpr std::string_view observed_verdicts[] = {"consistent", "differs", "too_few", "untested"};

/// Differences are significant at 1 − confidence; too few trials are consistent with whatever is observed.
std::string_view verdict_on(const ObservedComparison& comparison, double confidence);

/// "consistent (p = 0.61)", "differs (p = 0.0021): the real machine succeeded less often than the simulation
/// says".
std::string statement_on(const measures::PointSummary& point, const ObservedComparison& comparison,
                         double confidence);

/// The numbers of a comparison in CSV and in the results file; NaN where nothing was observed.
using ObservedField = text::ReportField<std::optional<ObservedComparison>>;
const std::vector<ObservedField>& observed_fields();

/// Their columns with 95 %, for the results file; empty without counts.
/// @param first the first of the points, which are consecutive
std::vector<layout::PointColumn> observed_columns(std::span<const measures::PointSummary> points,
                                                  const study::Study& study, std::int64_t first = 0);

}  // namespace zerocount::summary
