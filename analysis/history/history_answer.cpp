#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/history/series.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::history {
namespace {

using document::bounded;
using document::Description;
using document::everywhere;
using document::in_data;
using document::to_people;

/// A run of a series.
struct RunReading {
  const Series& series;
  std::size_t run;

  const RunIdentity& record() const { return *series.runs[run].run; }
  const RunValue& value() const { return series.runs[run].value; }
  auto changes(std::size_t SeriesChange::*at) const { return std::ranges::count(series.changes, run, at); }
};

struct ChangeReading {
  const Series& series;
  const SeriesChange& change;

  const RunIdentity& run(std::size_t index) const { return *series.runs[index].run; }
};

struct ComparisonReading {
  const RunIdentity& run;
  ValueComparison compared;
};

/// A run, by its time and its commit.
struct RunPlace {
  std::string created;
  std::string git_commit;
};

RunPlace place_of(const RunIdentity& run) {
  return {run.created, run.git_commit};
}

RunPlace place_before(const ChangeReading& reading) {
  if (!reading.change.since_baseline) return place_of(reading.run(reading.change.first - 1));
  const RunComparison& compared = *reading.run(reading.change.significant).comparison;
  return {compared.baseline_created, compared.baseline_commit};
}

std::string value_text(const Series& series, double value) {
  return comparison::value_text(value, series.measure, series.unit);
}

std::string bounds_text(const Series& series, const RunValue& value) {
  return fmt::format("[{}, {}]", value_text(series, value.bounds.low), value_text(series, value.bounds.high));
}

Description<ComparisonReading> comparison_description() {
  using Compared = ValueComparison;
  const auto baseline =
      Description<RunComparison>()
          .value(in_data("baseline_created", "time of the baseline, UTC"), &RunComparison::baseline_created)
          .value(in_data("baseline_commit", "commit of the baseline"), &RunComparison::baseline_commit);
  const auto value = Description<Compared>()
                         .value(in_data("verdict", "verdict on the change"), &Compared::verdict)
                         .value(in_data("baseline", "value of the baseline"), &Compared::baseline)
                         .value(in_data("effect", "change for the worse, with one-sided bounds"),
                                [](const Compared& c) { return bounded(c.effect, c.bounds); })
                         .value(in_data("margin", "largest accepted effect"), &Compared::margin)
                         .value(in_data("p", "two-sided p-value of no difference", "1"), &Compared::p);
  return Description<ComparisonReading>()
      .include(value, &ComparisonReading::compared)
      .include(
          baseline, [](const ComparisonReading& r) -> const auto& { return r.run.comparison; });
}

std::string note_on(const RunReading& reading) {
  const bool changed = reading.changes(&SeriesChange::first) > 0;
  const bool significant = reading.changes(&SeriesChange::significant) > 0;
  return fmt::format("{}{}{}", changed ? "changed" : "", changed && significant ? " " : "",
                     significant ? "significant" : "");
}

Description<RunReading> run_description() {
  using Run = const RunReading&;
  return Description<RunReading>()
      .value(everywhere("created", "run", "time of the run, UTC"), [](Run r) { return r.record().created; })
      .value(in_data("git_commit", "commit of the program"), [](Run r) { return r.record().git_commit; })
      .value(to_people("commit"), [](Run r) { return r.record().git_commit.substr(0, 10); })
      .value(in_data("zerocount_version", "version of the program"),
             [](Run r) { return r.record().zerocount_version; })
      .value(in_data("study_sha256", "hash of the study"), [](Run r) { return r.record().study_sha256; })
      .value(everywhere("seed", "seed", "seed of the study, decimal"), [](Run r) { return r.record().seed; })
      .value(everywhere("trials", "trials", "trials per design point"),
             [](Run r) { return r.record().trials; })
      .value(in_data("n", "trials or values that the value is of"), [](Run r) { return r.value().n; })
      .value(in_data("value", "value of the measure, in its unit, with 95 % bounds"),
             [](Run r) { return bounded(r.value().value, r.value().bounds); })
      .value(to_people("value"), [](Run r) { return value_text(r.series, r.value().value); })
      .value(to_people("95 % bounds"), [](Run r) { return bounds_text(r.series, r.value()); })
      .object(in_data("comparison", "comparison with the baseline"), comparison_description(),
              [](Run r) -> std::optional<ComparisonReading> {
                if (!r.value().comparison) return {};
                return ComparisonReading{r.record(), *r.value().comparison};
              })
      .value(to_people("verdict"),
             [](Run r) { return r.value().comparison ? r.value().comparison->verdict : std::string(); })
      .value(in_data("changed", "changes after which this is the first run"),
             [](Run r) { return r.changes(&SeriesChange::first); })
      .value(in_data("significant", "changes that are significant since this run"),
             [](Run r) { return r.changes(&SeriesChange::significant); })
      .value(to_people("change"), note_on);
}

Description<ChangeReading> change_description() {
  using Change = const ChangeReading&;
  const auto place = Description<RunPlace>()
                         .value(in_data("created", "time of the run, UTC"), &RunPlace::created)
                         .value(in_data("git_commit", "commit of the program"), &RunPlace::git_commit);
  return Description<ChangeReading>()
      .value(in_data("before", "level before the change"), [](Change c) { return c.change.before; })
      .value(in_data("after", "level after the change"), [](Change c) { return c.change.after; })
      .value(in_data("since_baseline", "whether the change lies between the baseline and the first run"),
             [](Change c) { return c.change.since_baseline; })
      .object(in_data("last_run_before", "last run, or the baseline, before the change"), place, place_before)
      .object(in_data("first_run_after", "first run after the change"), place,
              [](Change c) { return place_of(c.run(c.change.first)); })
      .object(in_data("significant_since", "run at which the change was significant"), place,
              [](Change c) { return place_of(c.run(c.change.significant)); })
      .value(in_data("z", "signed root of the likelihood ratio statistic, of the test levels", "1"),
             [](Change c) { return c.change.z; })
      .value(in_data("p", "two-sided p-value, of the test baseline", "1"),
             [](Change c) { return c.change.p; })
      .value(in_data("sentence", "the change in words"),
             [](Change c) { return change_sentence(c.series, c.change); });
}

std::vector<RunReading> run_readings(const Series& series) {
  std::vector<RunReading> runs;
  for (std::size_t run = 0; run < series.runs.size(); ++run) runs.push_back({series, run});
  return runs;
}

std::vector<ChangeReading> change_readings(const Series& series) {
  std::vector<ChangeReading> changes;
  for (const SeriesChange& change : series.changes) changes.push_back({series, change});
  return changes;
}

Description<Series> series_description() {
  using Of = const Series&;
  return Description<Series>()
      .value(everywhere("study", "study", "name of the study"), &Series::study)
      .value(in_data("series_sha256", "hash of the question, equal for all runs"), &Series::series_sha256)
      .value(everywhere("point", "point", "label of the design point"), &Series::point)
      .value(everywhere("measure", "measure", "name of the measure"), &Series::measure)
      .value(in_data("unit", "unit of the values"), &Series::unit)
      .value(document::with_words(in_data("test", "how the series is tested"), {"levels", "baseline"}),
             [](Of s) { return s.test == SeriesTest::levels ? "levels" : "baseline"; })
      .value(to_people("since"), [](Of s) { return s.runs.front().run->created.substr(0, 10); })
      .value(to_people("runs"), [](Of s) { return s.runs.size(); })
      .value(to_people("first"), [](Of s) { return value_text(s, s.runs.front().value.value); })
      .value(to_people("last"), [](Of s) { return value_text(s, s.runs.back().value.value); })
      .value(to_people("95 % bounds"), [](Of s) { return bounds_text(s, s.runs.back().value); })
      .value(to_people("changes"), [](Of s) { return s.changes.size(); })
      .table(in_data("runs", "runs by time"), run_description(), run_readings)
      .table(in_data("changes", "changes that are significant"), change_description(), change_readings);
}

std::string headline(const History& history) {
  const auto changed =
      std::ranges::count_if(history.series, [](const Series& s) { return !s.changes.empty(); });
  if (changed == 0) return "No change is significant.";
  return fmt::format("{} of {} series changed.", changed, history.series.size());
}

std::string changes_sentences(const History& history) {
  std::string text;
  for (const Series& series : history.series) {
    for (const SeriesChange& change : series.changes) {
      text += text::printable(fmt::format("{}, {}, {}: {}", series.study, series.point, series.measure,
                                          change_sentence(series, change))) +
              "\n";
    }
  }
  return text;
}

}  // namespace

document::AnswerDescription<History> history_answer() {
  using Of = const History&;
  document::AnswerDescription<History> answer{
      {.name = "history", .meaning = "results over time, and when they changed", .csv_table = "series.runs"},
      {}};
  answer.items.headline(headline)
      .sentence(changes_sentences)
      .sentence(false_alarm_sentence)
      .sentence([](Of h) {
        if (h.others.empty()) return std::string();
        return fmt::format("Studies with a goal are judged by it; with --measure also: {}",
                           fmt::join(h.others, ", "));
      })
      .value(in_data("false_alarm_probability", "probability of a change in any series without cause", "1"),
             [](Of) { return false_alarm_probability; })
      .value(in_data("false_alarm_runs", "runs within which it has this probability", "1"),
             [](Of) { return false_alarm_runs; })
      .value(in_data("threshold", "limit of |z| of the test levels", "1"), &History::threshold)
      .value(in_data("max_p", "limit of p of the test baseline", "1"), &History::max_p)
      .table(everywhere("series", "Series", "a measure at a point in all runs"), series_description(),
             &History::series)
      .table(to_people("Runs"), run_description(), [](Of h) {
        return h.series.size() == 1 ? run_readings(h.series.front()) : std::vector<RunReading>();
      });
  return answer;
}

}  // namespace zerocount::history
