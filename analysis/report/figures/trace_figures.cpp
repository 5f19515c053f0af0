#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/goal/goal_text.hpp"
#include "analysis/report/figures/report_figures.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

/// The rows of a point that a report shows; −1 for none.
struct RowsOfPoint {
  std::int64_t median{-1};
  std::int64_t worst{-1};
  std::int64_t first_failure{-1};
};

RowsOfPoint rows_to_show(const ReportedStudy& reported) {
  const goal::Question& question = question_of(reported);
  RowsOfPoint rows;
  goal::Badness worst{};
  const double median = settling_of(question, point_of(reported, reported.chosen.point)).median.value;
  measures::visit_trials(reported.file, rows_of(reported, reported.chosen.point),
                         [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
                           const goal::Badness badness = badness_of(question, moves);
                           if (rows.worst < 0 || worst < badness) {
                             worst = badness;
                             rows.worst = row;
                           }
                           const bool failed = !meets(question, moves);
                           if (failed && rows.first_failure < 0) rows.first_failure = row;
                           const bool typical =
                               std::ranges::any_of(moves, [&](const trial::MoveOutcome& move) {
                                 return settling_time(question, {&move, 1}) == median;
                               });
                           if (!failed && typical && rows.median < 0) rows.median = row;
                         });
  return rows;
}

std::int64_t first_failure_of_study(const ReportedStudy& reported) {
  std::int64_t first = -1;
  for (std::int64_t point = 0; point < std::ssize(reported.summary.points) && first < 0; ++point) {
    const measures::MoveCounts counts = counts_of(question_of(reported), point_of(reported, point));
    if (counts.met == counts.moves) continue;
    measures::visit_trials(reported.file, rows_of(reported, point),
                           [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
                             if (first < 0 && !meets(question_of(reported), moves)) first = row;
                           });
  }
  return first;
}

/// "the first move arrives after 0.0275 s; it ends at zero counts".
std::string course_of(const goal::Question& question, std::span<const trial::MoveOutcome> moves) {
  const double time = settling_time(question, moves.first(1));
  const std::string_view settles = words_of(question).settles;
  return fmt::format("{}{}; {}", moves.size() == 1 ? "" : "the first move ",
                     std::isfinite(time) ? fmt::format("{} after {:.4g} s", settles, time)
                                         : fmt::format("never {}", settles),
                     goal::ending_text(question, moves));
}

}  // namespace

std::vector<SampleTrial> sample_trials(const ReportedStudy& reported) {
  std::vector<SampleTrial> trials;
  if (reported.study.open_loop) return trials;
  RowsOfPoint rows = rows_to_show(reported);
  const bool elsewhere = rows.first_failure < 0;
  if (elsewhere) rows.first_failure = first_failure_of_study(reported);
  const auto add = [&](const char* name, std::string title, std::int64_t row) {
    if (row < 0) return;
    const std::int64_t point = row / reported.file.header().trials;
    const std::int64_t index = row % reported.file.header().trials;
    for (SampleTrial& other : trials) {
      if (other.point != point || other.index != index) continue;
      other.title += ", and " + title;
      return;
    }
    trials.push_back({name, std::move(title), point, index});
  };
  add("median", "the median trial", rows.median);
  add("worst", "the worst trial", rows.worst);
  add("first-failure",
      fmt::format("the first trial {}that {}", elsewhere ? "of the study " : "",
                  words_of(question_of(reported)).failed),
      rows.first_failure);
  for (SampleTrial& trial : trials) trial.title.front() = 'T';
  return trials;
}

Figure trace_figure(const ReportedStudy& reported, const SampleTrial& trial, const ReplayedTrial& replayed) {
  std::string caption = fmt::format(
      "Error and $torque over time of trial {} of point {}{}, simulated again: {}. The error should reach "
      "the dashed line and stay there. Its scale is linear within one count and logarithmic beyond. Samples "
      "are thinned, but all extremes are shown.",
      trial.index, label_of(reported, trial.point),
      study::condition_text(reported.study, study::turns_of(reported.study).condition_of(trial.index)),
      course_of(question_of(reported), replayed.result.outcome.moves));
  using Sample = const trial::SampleRecord&;
  return figure_of(
      "trace", "trace-" + trial.name, trial.title, caption,
      {data_of<trial::SampleRecord>("samples", replayed.samples,
                                    {{{"time", "time", "s"}, [](Sample s) { return datum(s.t, 9); }},
                                     {{"error", "error", "count"}, [](Sample s) { return s.error; }},
                                     {{"torque", "$torque", "N m"}, [](Sample s) { return datum(s.torque); }},
                                     {{"target", "target", "count"}, [](Sample s) { return s.target; }}})});
}

}  // namespace zerocount::report
