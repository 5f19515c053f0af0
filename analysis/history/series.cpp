#include "analysis/history/series.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/comparison/gate_rules.hpp"
#include "analysis/statistics/change_point.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::history {
namespace {

bool matches(const std::optional<std::string>& wanted, const std::string& value) {
  return !wanted || *wanted == value;
}

bool is_of_goal(const RunValue& value) {
  return std::ranges::any_of(comparison::goal_measures(), [&](const comparison::GateMeasure& measure) {
    return measure.name == comparison::without_goal(value.measure);
  });
}

std::vector<Series> sorted_into_series(const std::vector<RunRecord>& runs, const SeriesFilter& filter,
                                       std::set<std::string>& others) {
  std::vector<Series> all;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> places;
  for (const RunRecord& run : runs) {
    if (!matches(filter.study, run.study) || !matches(filter.series_sha256, run.series_sha256)) continue;
    const auto identity = std::make_shared<const RunIdentity>(run);
    const bool by_goal = !filter.measure && std::ranges::any_of(run.values, is_of_goal);
    for (const RunValue& value : run.values) {
      if (!matches(filter.point, value.point) || !matches(filter.measure, value.measure)) continue;
      if (by_goal && !is_of_goal(value)) {
        others.insert(value.measure);
        continue;
      }
      const auto [place, is_new] =
          places.try_emplace({run.series_sha256, value.point, value.measure}, all.size());
      if (is_new)
        all.push_back({run.study, run.series_sha256, value.point, value.measure, value.unit, {}, {}, {}});
      all[place->second].runs.push_back({identity, value});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Series& one, const Series& other) {
    return std::tie(one.study, one.runs.front().run->created) <
           std::tie(other.study, other.runs.front().run->created);
  });
  return all;
}

SeriesTest test_of(const Series& series) {
  const bool one_seed = std::all_of(series.runs.begin(), series.runs.end(), [&](const SeriesRun& one) {
    return one.run->seed == series.runs.front().run->seed;
  });
  const bool compared = std::any_of(series.runs.begin(), series.runs.end(),
                                    [](const SeriesRun& one) { return one.value.comparison.has_value(); });
  return one_seed && compared ? SeriesTest::baseline : SeriesTest::levels;
}

std::optional<statistics::Measurement> measurement_of(const RunValue& value) {
  const auto measured = value.kind == statistics::MeasurementKind::proportion
                            ? statistics::measured_proportion
                            : statistics::measured_mean;
  return measured(value.value, static_cast<double>(value.n), value.bounds, statistics::summary_confidence);
}

std::vector<SeriesChange> changes_of_levels(const Series& series, double threshold) {
  std::vector<statistics::Measurement> measurements;
  std::vector<std::size_t> places;  // [measurement] its run
  std::map<std::string, std::size_t> draws;
  for (std::size_t i = 0; i < series.runs.size(); ++i) {
    std::optional<statistics::Measurement> measured = measurement_of(series.runs[i].value);
    if (!measured) continue;
    measured->draws = draws.try_emplace(series.runs[i].run->seed, draws.size()).first->second;
    measurements.push_back(*measured);
    places.push_back(i);
  }
  std::vector<SeriesChange> changes;
  for (const statistics::LevelChange& one :
       statistics::level_changes(series.runs.front().value.kind, measurements, threshold)) {
    SeriesChange change{places[one.first], places[one.detected]};
    change.before = one.before;
    change.after = one.after;
    change.z = one.z;
    changes.push_back(change);
  }
  return changes;
}

/// The runs from `start` to `last`, divided where the levels before and after differ most; the baseline's
/// value stands before the first.
SeriesChange divided_since_baseline(const Series& series, std::size_t start, std::size_t last) {
  std::vector<double> values{series.runs[last].value.comparison->baseline};
  for (std::size_t i = start; i <= last; ++i) values.push_back(series.runs[i].value.value);
  SeriesChange best{start, last, true};
  double strongest = -1.0;
  double before = 0.0;
  double after = 0.0;
  for (const double value : values) after += value;
  for (std::size_t k = 1; k < values.size(); ++k) {
    before += values[k - 1];
    after -= values[k - 1];
    const auto n = static_cast<double>(k);
    const auto m = static_cast<double>(values.size() - k);
    const double strength = std::abs(before / n - after / m) * std::sqrt(n * m);
    if (strength <= strongest) continue;
    strongest = strength;
    best = {start + k - 1, last, k == 1, before / n, after / m};
  }
  return best;
}

std::vector<SeriesChange> changes_since_baseline(const Series& series, double max_p) {
  std::vector<SeriesChange> changes;
  std::string baseline;
  std::size_t start = 0;  // first run against this baseline
  bool found = false;     // against this baseline
  for (std::size_t i = 0; i < series.runs.size(); ++i) {
    const auto& [run, value] = series.runs[i];
    if (!value.comparison || !run->comparison) continue;
    const std::string against = run->comparison->baseline_created + run->comparison->baseline_commit;
    if (against != baseline) {
      baseline = against;
      start = i;
      found = false;
    }
    if (found || !(value.comparison->p <= max_p)) continue;
    found = true;
    changes.push_back(divided_since_baseline(series, start, i));
    changes.back().p = value.comparison->p;
  }
  return changes;
}

[[noreturn]] void fail_empty(const std::vector<RunRecord>& runs) {
  std::set<std::string> studies;
  std::set<std::string> points;
  std::set<std::string> measures;
  for (const RunRecord& run : runs) {
    studies.insert(run.study);
    for (const RunValue& value : run.values) {
      points.insert(value.point);
      measures.insert(value.measure);
    }
  }
  throw Failure(
      ExitCode::bad_input,
      fmt::format("the history has no such values; it has the studies {}; the points {}; the measures {}",
                  fmt::join(studies, ", "), fmt::join(points, ", "), fmt::join(measures, ", ")));
}

/// "2026-11-22T02:30:00Z (commit 1a2b3c4d5e)".
std::string place_text(const std::string& created, const std::string& commit) {
  constexpr std::size_t shown = 10;
  const bool is_hash = commit.size() >= 40;
  const bool dirty = commit.ends_with("-dirty");
  return fmt::format("{} (commit {}{})", created, is_hash ? commit.substr(0, shown) : commit,
                     is_hash && dirty ? "-dirty" : "");
}

std::string place_text(const RunIdentity& run) {
  return place_text(run.created, run.git_commit);
}

std::string place_before(const Series& series, const SeriesChange& change) {
  if (!change.since_baseline) return place_text(*series.runs[change.first - 1].run);
  const RunComparison& compared = *series.runs[change.significant].run->comparison;
  return "the baseline of " + place_text(compared.baseline_created, compared.baseline_commit);
}

}  // namespace

History history_of(const std::vector<RunRecord>& runs, const SeriesFilter& filter) {
  History history;
  history.series = sorted_into_series(runs, filter, history.others);
  if (history.series.empty()) fail_empty(runs);
  const double per_run =
      false_alarm_probability / (false_alarm_runs * static_cast<double>(history.series.size()));
  history.threshold = statistics::change_threshold(per_run);
  history.max_p = per_run;
  for (Series& series : history.series) {
    series.test = test_of(series);
    series.changes = series.test == SeriesTest::levels ? changes_of_levels(series, history.threshold)
                                                       : changes_since_baseline(series, history.max_p);
  }
  return history;
}

std::string change_sentence(const Series& series, const SeriesChange& change) {
  const auto value = [&](double number) {
    return comparison::value_text(number, series.measure, series.unit);
  };
  return fmt::format("{} from {} to {} between {} and {}; significant since {}",
                     change.after > change.before ? "rose" : "fell", value(change.before),
                     value(change.after), place_before(series, change),
                     place_text(*series.runs[change.first].run),
                     place_text(*series.runs[change.significant].run));
}

std::string false_alarm_sentence(const History& history) {
  return fmt::format(
      "Where nothing changed, the probability that any of {} series shows a change within {:.0f} runs is at "
      "most about {:.0f} %.",
      history.series.size(), false_alarm_runs, 100.0 * false_alarm_probability);
}

}  // namespace zerocount::history
