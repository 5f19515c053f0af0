#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/history/run_record.hpp"

namespace zerocount::history {

/// Probability of a false alarm in any of the examined series within false_alarm_runs runs.
inline constexpr double false_alarm_probability = 0.05;
inline constexpr double false_alarm_runs = 100.0;

/// Selects the series to be examined. A member without a value does not restrict the selection. For a study
/// with a goal, however, only the measures of the goal are examined unless a measure is named.
struct SeriesFilter {
  std::optional<std::string> study{};
  std::optional<std::string> point{};
  std::optional<std::string> measure{};
  std::optional<std::string> series_sha256{};
};

/// Test for changes in a series (README.md).
enum class SeriesTest {
  /// Test by statistics::level_changes(): the runs drew different random numbers.
  levels,
  /// Test by the comparison of each run with the baseline: the runs share their random numbers.
  baseline
};

/// One run of a series.
struct SeriesRun {
  std::shared_ptr<const RunIdentity> run{};  ///< Identity of the run, shared by all series of the run.
  RunValue value{};
  std::int64_t changed{0};      ///< Number of changes for which this is the first run after the change.
  std::int64_t significant{0};  ///< Number of changes that became significant at this run.
};

/// A run or a baseline, identified by time and commit.
struct RunPlace {
  std::string created;
  std::string git_commit;
};

/// A change that became significant. Runs are given as indices in Series::runs.
struct SeriesChange {
  std::size_t first{0};        ///< First run after the change, as estimated.
  std::size_t significant{0};  ///< Run at which the change became significant.
  bool since_baseline{false};  ///< True if the change lies between the baseline and run `first`.
  double before{statistics::unknown};
  double after{statistics::unknown};  ///< Mean over the runs from `first` to `significant`.
  /// For SeriesTest::levels: signed root of the likelihood ratio statistic.
  double z{statistics::unknown};
  double p{statistics::unknown};  ///< For SeriesTest::baseline: two-sided p-value.
  RunPlace last_before{}, first_after{}, significant_since{};
  /// "rose from 36.5 % to 41 % between 2026-01-01 (commit 1a2b3c4) and 2026-01-02 (commit …); significant
  /// since …".
  std::string sentence{};
};

/// The values of one measure at one point in all runs of one series.
struct Series {
  std::string study;
  std::string series_sha256;
  std::string point;
  std::string measure;
  std::string unit;
  std::vector<SeriesRun> runs;  ///< Runs, sorted by time.
  SeriesTest test{SeriesTest::levels};
  std::vector<SeriesChange> changes;
};

/// The requested series, and the thresholds of their tests.
struct History {
  std::vector<Series> series;
  double threshold{statistics::unknown};  ///< Threshold of |z| for SeriesTest::levels.
  double max_p{statistics::unknown};      ///< Largest significant p for SeriesTest::baseline.
  std::set<std::string> others{};         ///< Names of measures besides the goal's that were not requested.
};

/// Sorts runs into series and finds their changes. With m series, the probability of a false alarm within
/// false_alarm_runs runs is false_alarm_probability/m in each (Bonferroni).
/// @param runs sorted by time
/// @throws Failure (bad_input) if the filter leaves nothing; the message lists what there is.
History history_of(const std::vector<RunRecord>& runs, const SeriesFilter& filter = {});

/// The answer of `history show`: a row per series, the changes in words, and for a single series every run.
document::AnswerDescription<History> history_answer();

}  // namespace zerocount::history
