#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/pairs/history/run_record.hpp"

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

/// Statistical test that finds changes in a series of runs (README.md).
enum class SeriesTest {
  /// Test of the values themselves by statistics::level_changes(), for runs that drew different random
  /// numbers.
  levels,
  /// Test of the comparison of each run with the baseline, for runs that share their random numbers.
  baseline
};

/// The value of one measure at one design point in one run.
struct SeriesRun {
  std::shared_ptr<const RunIdentity> run{};  ///< Identity of the run, shared by all series of the run.
  RunValue value{};
  /// Number of changes of the series for which this is the first run after the change.
  std::int64_t changed{0};
  std::int64_t significant{0};  ///< Number of changes of the series that became significant at this run.
};

/// Time and commit of a run or of a baseline, which identify it for the reader.
struct RunPlace {
  std::string created;
  std::string git_commit;
};

/// A significant change of the value within a series. Runs are given as indices in Series::runs.
struct SeriesChange {
  std::size_t first{0};        ///< Index of the first run after the change, as estimated.
  std::size_t significant{0};  ///< Index of the run with which the change became significant.
  /// True if the change lies between the baseline and run `first`; false if it lies between two runs.
  bool since_baseline{false};
  double before{statistics::unknown};
  /// Mean value over the runs from `first` to `significant`, after the change.
  double after{statistics::unknown};
  /// For SeriesTest::levels: signed root of the likelihood ratio statistic of the change; otherwise unknown
  /// (NaN).
  double z{statistics::unknown};
  /// For SeriesTest::baseline: two-sided p-value of the change; otherwise unknown (NaN).
  double p{statistics::unknown};
  RunPlace last_before{}, first_after{}, significant_since{};
  /// The change in words: "rose from 36.5 % to 41 % between 2026-01-01 (commit 1a2b3c4) and 2026-01-02
  /// (commit …); significant since …".
  std::string sentence{};
};

/// The values of one measure at one design point in all runs of one series, and the changes found in them.
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
  /// Threshold of |z| above which a change is significant with SeriesTest::levels.
  double threshold{statistics::unknown};
  double max_p{statistics::unknown};  ///< Largest p-value that is significant with SeriesTest::baseline.
  /// Names of measures that were not examined because only the measures of a goal were, and none was
  /// requested by name.
  std::set<std::string> others{};
};

/// Groups runs into series of one measure at one design point, and finds the changes of each series. With m
/// series, the probability of a false alarm within false_alarm_runs runs is false_alarm_probability/m in each
/// (Bonferroni).
/// @param runs sorted by time
/// @param filter selection of the series
/// @throws Failure (bad_input) if the filter leaves nothing; the message lists what there is.
History history_of(const std::vector<RunRecord>& runs, const SeriesFilter& filter = {});

/// The answer of `history show`: a row per series, the changes in words, and for a single series every run.
document::AnswerDescription<History> history_answer();

}  // namespace zerocount::history
