#include "analysis/pairs/history/series.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/statistics/change_point.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/comparison/gate_rules.hpp"
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

/// The change between two groups of runs: the runs from `start` to `last` are divided where the levels before
/// and after differ most. The baseline's value counts as a run before the first one.
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
    const RunValue& value = series.runs[i].value;
    const auto& run = series.runs[i].run;
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

/// Text of the time and the commit of a run: "2026-11-22T02:30:00Z (commit 1a2b3c4d5e)".
std::string place_text(const RunPlace& place) {
  constexpr std::size_t shown = 10;
  const std::string& commit = place.git_commit;
  const bool is_hash = commit.size() >= 40;
  return fmt::format("{} (commit {}{})", place.created, is_hash ? commit.substr(0, shown) : commit,
                     is_hash && commit.ends_with("-dirty") ? "-dirty" : "");
}

std::string value_text(const RunValue& of, double value) {
  return comparison::value_text(value, of.measure, of.unit);
}

/// Text of a value with its bounds: "36.5 % [30 %, 43 %]".
std::string bounded_text(const RunValue& value) {
  return fmt::format("{} [{}, {}]", value_text(value, value.value), value_text(value, value.bounds.low),
                     value_text(value, value.bounds.high));
}

/// Fills in the text members of a change: the times and commits of its runs and the sentence. Also counts the
/// change at its runs in the series.
void describe(Series& series, SeriesChange& change) {
  const auto place_of = [&](std::size_t run) {
    return RunPlace{series.runs[run].run->created, series.runs[run].run->git_commit};
  };
  ++series.runs[change.first].changed;
  ++series.runs[change.significant].significant;
  change.first_after = place_of(change.first);
  change.significant_since = place_of(change.significant);
  if (change.since_baseline) {
    const RunComparison& compared = *series.runs[change.significant].run->comparison;
    change.last_before = {compared.baseline_created, compared.baseline_commit};
  } else {
    change.last_before = place_of(change.first - 1);
  }
  const RunValue& of = series.runs.front().value;
  change.sentence = fmt::format("{} from {} to {} between {}{} and {}; significant since {}",
                                change.after > change.before ? "rose" : "fell", value_text(of, change.before),
                                value_text(of, change.after), change.since_baseline ? "the baseline of " : "",
                                place_text(change.last_before), place_text(change.first_after),
                                place_text(change.significant_since));
}

using document::Description;
using document::everywhere;
using document::in_data;
using document::to_people;
using Run = const SeriesRun&;

/// Description of the columns that show the comparison of a run's value with the baseline; empty cells for
/// runs that were not compared.
Description<SeriesRun> comparison_description() {
  const auto of_value =
      Description<ValueComparison>()
          .value(in_data("verdict", "verdict on the change"), &ValueComparison::verdict)
          .value(in_data("baseline", "value of the baseline"), &ValueComparison::baseline)
          .value(in_data("effect", "change for the worse, with one-sided bounds"),
                 [](const ValueComparison& c) { return document::bounded(c.effect, c.bounds); })
          .value(in_data("margin", "largest accepted effect"), &ValueComparison::margin)
          .value(in_data("p", "two-sided p-value of no difference", "1"), &ValueComparison::p);
  const auto of_run =
      Description<RunComparison>()
          .value(in_data("baseline_created", "time of the baseline, UTC"), &RunComparison::baseline_created)
          .value(in_data("baseline_commit", "commit of the baseline"), &RunComparison::baseline_commit);
  return Description<SeriesRun>()
      .include(of_value, [](Run r) -> const ValueComparison& { return *r.value.comparison; })
      .include(of_run, [](Run r) { return r.run->comparison; });
}

Description<SeriesRun> run_description() {
  const auto of_run =
      Description<RunIdentity>()
          .value(everywhere("created", "run", "time of the run, UTC"), &RunIdentity::created)
          .value(everywhere("git_commit", "commit", "commit of the program"), &RunIdentity::git_commit)
          .shown_as([](const RunIdentity& run) { return run.git_commit.substr(0, 10); })
          .value(in_data("zerocount_version", "version of the program"), &RunIdentity::zerocount_version)
          .value(in_data("study_sha256", "hash of the study"), &RunIdentity::study_sha256)
          .value(everywhere("seed", "seed", "seed of the study, decimal"), &RunIdentity::seed)
          .value(everywhere("trials", "trials", "trials per design point"), &RunIdentity::trials);
  return Description<SeriesRun>()
      .include(of_run, [](Run r) -> const RunIdentity& { return *r.run; })
      .value(in_data("n", "trials or values from which the value is computed"),
             [](Run r) { return r.value.n; })
      .value(
          everywhere("value", "value and 95 % bounds", "value of the measure, in its unit, with 95 % bounds"),
          [](Run r) { return document::bounded(r.value.value, r.value.bounds); })
      .shown_as([](Run r) { return bounded_text(r.value); })
      .object(in_data("comparison", "comparison with the baseline"), comparison_description(),
              [](Run r) { return r.value.comparison ? &r : nullptr; })
      .value(to_people("verdict"),
             [](Run r) { return r.value.comparison ? r.value.comparison->verdict : std::string(); })
      .value(everywhere("changed", "changed", "changes after which this is the first run"),
             &SeriesRun::changed)
      .value(everywhere("significant", "significant", "changes that are significant since this run"),
             &SeriesRun::significant);
}

Description<SeriesChange> change_description() {
  const auto place = Description<RunPlace>()
                         .value(in_data("created", "time of the run, UTC"), &RunPlace::created)
                         .value(in_data("git_commit", "commit of the program"), &RunPlace::git_commit);
  return Description<SeriesChange>()
      .value(in_data("before", "level before the change"), &SeriesChange::before)
      .value(in_data("after", "level after the change"), &SeriesChange::after)
      .value(in_data("since_baseline", "whether the change lies between the baseline and the first run"),
             &SeriesChange::since_baseline)
      .object(in_data("last_run_before", "last run, or the baseline, before the change"), place,
              &SeriesChange::last_before)
      .object(in_data("first_run_after", "first run after the change"), place, &SeriesChange::first_after)
      .object(in_data("significant_since", "run at which the change was significant"), place,
              &SeriesChange::significant_since)
      .value(in_data("z", "signed root of the likelihood ratio statistic, of the test levels", "1"),
             &SeriesChange::z)
      .value(in_data("p", "two-sided p-value, of the test baseline", "1"), &SeriesChange::p)
      .value(in_data("sentence", "the change in words"), &SeriesChange::sentence);
}

Description<Series> series_description() {
  return Description<Series>()
      .value(everywhere("study", "study", "name of the study"), &Series::study)
      .value(in_data("series_sha256", "hash of the question, equal for all runs"), &Series::series_sha256)
      .value(everywhere("point", "point", "label of the design point"), &Series::point)
      .value(everywhere("measure", "measure", "name of the measure"), &Series::measure)
      .value(in_data("unit", "unit of the values"), &Series::unit)
      .value(document::with_words(in_data("test", "how the series is tested"), {"levels", "baseline"}),
             [](const Series& s) { return s.test == SeriesTest::levels ? "levels" : "baseline"; })
      .value(to_people("since"), [](const Series& s) { return s.runs.front().run->created.substr(0, 10); })
      .value(to_people("runs"), [](const Series& s) { return s.runs.size(); })
      .value(to_people("first"),
             [](const Series& s) { return value_text(s.runs[0].value, s.runs[0].value.value); })
      .value(to_people("last, with 95 % bounds"),
             [](const Series& s) { return bounded_text(s.runs.back().value); })
      .value(to_people("changes"), [](const Series& s) { return s.changes.size(); })
      .table(in_data("runs", "runs by time"), run_description(), &Series::runs)
      .table(in_data("changes", "changes that are significant"), change_description(), &Series::changes);
}

std::string headline(const History& history) {
  const auto changed =
      std::ranges::count_if(history.series, [](const Series& s) { return !s.changes.empty(); });
  if (changed == 0) return "No change is significant.";
  return fmt::format("{} of {} series changed.", changed, history.series.size());
}

/// Sentences for the reader on the changes of all series, and on the probability of a false alarm.
std::string sentences(const History& history) {
  std::string text;
  for (const Series& series : history.series)
    for (const SeriesChange& change : series.changes)
      text += text::printable(fmt::format("{}, {}, {}: {}", series.study, series.point, series.measure,
                                          change.sentence)) +
              "\n";
  text += fmt::format(
      "Where nothing changed, the probability that any of {} series shows a change within {:.0f} runs is at "
      "most about {:.0f} %.",
      history.series.size(), false_alarm_runs, 100.0 * false_alarm_probability);
  if (!history.others.empty())
    text += fmt::format("\nStudies with a goal are judged by it; with --measure also: {}",
                        fmt::join(history.others, ", "));
  return text;
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
    for (SeriesChange& change : series.changes) describe(series, change);
  }
  return history;
}

document::AnswerDescription<History> history_answer() {
  document::AnswerDescription<History> answer{
      {.name = "history", .meaning = "results over time, and when they changed", .csv_table = "series.runs"},
      {}};
  answer.items.headline(headline)
      .sentence(sentences)
      .value(in_data("false_alarm_probability", "probability of a change in any series without cause", "1"),
             [](const History&) { return false_alarm_probability; })
      .value(in_data("false_alarm_runs", "runs within which it has this probability", "1"),
             [](const History&) { return false_alarm_runs; })
      .value(in_data("threshold", "limit of |z| of the test levels", "1"), &History::threshold)
      .value(in_data("max_p", "limit of p of the test baseline", "1"), &History::max_p)
      .table(everywhere("series", "Series", "a measure at a point in all runs"), series_description(),
             &History::series)
      .table(to_people("Runs"), run_description(), [](const History& h) {
        return h.series.size() == 1 ? h.series.front().runs : std::vector<SeriesRun>();
      });
  return answer;
}

}  // namespace zerocount::history
