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

/// Probability of a false alarm, in any of the series looked at, within false_alarm_runs runs.
inline constexpr double false_alarm_probability = 0.05;
inline constexpr double false_alarm_runs = 100.0;

/// Which series are looked at; what is missing is not restricted, but of a study with a goal only the
/// measures of the goal are looked at unless one is named.
struct SeriesFilter {
  std::optional<std::string> study{};
  std::optional<std::string> point{};
  std::optional<std::string> measure{};
  std::optional<std::string> series_sha256{};
};

/// How a series is tested (README.md).
enum class SeriesTest {
  levels,   ///< statistics::level_changes: the runs drew different random numbers
  baseline  ///< the runs share their draws: each is judged by its comparison with the baseline
};

/// One run of a series.
struct SeriesRun {
  std::shared_ptr<const RunIdentity> run{};  ///< which all series of the run share
  RunValue value{};
  std::int64_t changed{0};      ///< changes after which this is the first run
  std::int64_t significant{0};  ///< changes that are significant since this run
};

/// A run, or a baseline, by its time and its commit.
struct RunPlace {
  std::string created;
  std::string git_commit;
};

/// A change that became significant. Indices are of SeriesRun.
struct SeriesChange {
  std::size_t first{0};        ///< first run after the change, as estimated
  std::size_t significant{0};  ///< run at which the change was significant
  bool since_baseline{false};  ///< the change lies between the baseline and run `first`
  double before{statistics::unknown};
  double after{statistics::unknown};  ///< mean over the runs from `first` to `significant`
  double z{statistics::unknown};  ///< of SeriesTest::levels: signed root of the likelihood ratio statistic
  double p{statistics::unknown};  ///< of SeriesTest::baseline: two-sided
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
  std::vector<SeriesRun> runs;  ///< by time
  SeriesTest test{SeriesTest::levels};
  std::vector<SeriesChange> changes;
};

/// The series that were asked for, and the limits of their tests.
struct History {
  std::vector<Series> series;
  double threshold{statistics::unknown};  ///< of |z|, of SeriesTest::levels
  double max_p{statistics::unknown};      ///< of SeriesTest::baseline
  std::set<std::string> others{};         ///< measures beside a goal that were not asked for
};

/// Sorts runs into series and finds their changes. With m series, each is tested so that it gives a false
/// alarm with the probability false_alarm_probability/m within false_alarm_runs runs (Bonferroni).
/// @param runs by time
/// @throws Failure (bad_input) that lists what there is where the filter leaves nothing.
History history_of(const std::vector<RunRecord>& runs, const SeriesFilter& filter = {});

/// The answer of `history show`: a row per series, the changes in words, and of a single series every run.
document::AnswerDescription<History> history_answer();

}  // namespace zerocount::history
