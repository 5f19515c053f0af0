#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/statistics/clusters/observed_test.hpp"
#include "analysis/basis/text/report_field.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/point_statistics.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"

/// Comparison of counts on a real machine with the simulated trials of the same design point.
namespace zerocount::summary {

/// Comparison of the trials on a real machine with the simulation at a design point. The test is fisher_test;
/// with machines it is machine_rank_test, because all observed trials come from one machine. A trial succeeds
/// if it meets the question of the study (goal::Question): each of its moves meets all goals that judge it
/// or, without a goal, ends at zero counts.
struct ObservedComparison {
  study::ObservedCounts counts;
  statistics::Successes simulated{};  ///< Successes among the trials of the point, in all worlds.
  /// Result of the test; empty if the counts cannot be tested.
  std::optional<statistics::ObservedTest> test;
  std::string reason;  ///< Why the counts cannot be tested; otherwise empty.
  /// True if the simulated trials are those in the world (draw of what all machines share) that is most like
  /// the real machine.
  bool in_worlds{false};
};

ObservedComparison compare_observed(const goal::Question& question, const measures::PointSummary& point,
                                    const study::ObservedCounts& counts);

/// All words that verdict_on() may return.
inline constexpr std::string_view observed_verdicts[] = {"consistent", "differs", "too_few", "untested"};

/// The verdict on the comparison, one of observed_verdicts. "consistent": no significant difference.
/// "differs": the difference is significant at the level 1 − confidence. "too_few": there are so few trials
/// that any observation would be consistent. "untested": the counts cannot be tested.
std::string_view verdict_on(const ObservedComparison& comparison, double confidence);

/// Sentence on the comparison: "consistent (p = 0.61)", "differs (p = 0.0021): the real machine succeeded
/// less often than the simulation says".
std::string statement_on(const measures::PointSummary& point, const ObservedComparison& comparison,
                         double confidence);

/// The numbers of a comparison in CSV and in the results file; NaN if nothing was observed.
using ObservedField = text::ReportField<std::optional<ObservedComparison>>;
const std::vector<ObservedField>& observed_fields();

/// The values of observed_fields() as columns for the results file, at the confidence 95 %; empty without
/// observed counts.
/// @param points consecutive design points
/// @param first index of the first of these points
std::vector<layout::PointColumn> observed_columns(std::span<const measures::PointSummary> points,
                                                  const study::Study& study, std::int64_t first = 0);

}  // namespace zerocount::summary
