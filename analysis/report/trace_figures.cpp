#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/report/report_figures.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

/// Rank of a trial: the greater, the worse.
struct TrialRank {
  trial::Outcome outcome{trial::Outcome::zero_count};
  std::int64_t final_error{0};  ///< maximum |final error| of its moves, counts
  double settling_time{0.0};    ///< maximum of its moves, s; infinite if one never arrived

  bool operator<(const TrialRank& other) const {
    if (outcome != other.outcome) return trial::severity(outcome) < trial::severity(other.outcome);
    if (final_error != other.final_error) return final_error < other.final_error;
    return settling_time < other.settling_time;
  }
};

TrialRank rank_of(std::span<const trial::MoveOutcome> moves) {
  TrialRank rank{trial::worst_outcome(moves), 0, 0.0};
  for (const trial::MoveOutcome& move : moves) {
    rank.final_error = std::max(rank.final_error, std::abs(move.final_error));
    rank.settling_time = std::max(
        rank.settling_time, move.arrived ? move.settling_time : std::numeric_limits<double>::infinity());
  }
  return rank;
}

/// The rows of a point that a report shows; −1 for none.
struct RowsOfPoint {
  std::int64_t median{-1};
  std::int64_t worst{-1};
  std::int64_t first_failure{-1};
};

RowsOfPoint rows_to_show(const ReportedStudy& reported) {
  RowsOfPoint rows;
  TrialRank worst;
  const double median =
      point_of(reported, reported.chosen.point).of(&trial::MoveOutcome::settling_time).median.value;
  measures::visit_trials(reported.file, rows_of(reported, reported.chosen.point),
                         [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
                           const TrialRank rank = rank_of(moves);
                           if (rows.worst < 0 || worst < rank) {
                             worst = rank;
                             rows.worst = row;
                           }
                           const bool failed = !trial::is_success(rank.outcome);
                           if (failed && rows.first_failure < 0) rows.first_failure = row;
                           const bool typical =
                               std::any_of(moves.begin(), moves.end(), [&](const trial::MoveOutcome& move) {
                                 return move.arrived && move.settling_time == median;
                               });
                           if (!failed && typical && rows.median < 0) rows.median = row;
                         });
  return rows;
}

const char* ending_of(trial::Outcome outcome) {
  switch (outcome) {
    case trial::Outcome::zero_count:
      return "it ends at zero counts";
    case trial::Outcome::one_count:
      return "it ends within one count of the target";
    case trial::Outcome::off_target:
      return "it ends more than one count away: stalled, or still moving to the target";
    case trial::Outcome::oscillating:
      return "it ends oscillating by more than one count";
    case trial::Outcome::nonfinite:
      return "it failed numerically";
    case trial::Outcome::open_loop:
      break;
  }
  return "it has no target";
}

std::int64_t first_failure_of_study(const ReportedStudy& reported) {
  std::int64_t first = -1;
  for (std::size_t point = 0; point < reported.summary.points.size() && first < 0; ++point) {
    const measures::PointSummary& summary = reported.summary.points[point];
    if (summary.outcomes.zero_count == summary.trials) continue;
    measures::visit_trials(reported.file, rows_of(reported, static_cast<std::int64_t>(point)),
                           [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
                             if (first < 0 && !trial::succeeded(moves)) first = row;
                           });
  }
  return first;
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
  add("first-failure", elsewhere ? "the first trial of the study that failed" : "the first trial that failed",
      rows.first_failure);
  for (SampleTrial& trial : trials) trial.title.front() = 'T';
  return trials;
}

Figure trace_figure(const ReportedStudy& reported, const SampleTrial& trial, const ReplayedTrial& replayed) {
  const trial::Outcome outcome = trial::worst_outcome(replayed.result.outcome.moves);
  const trial::MoveOutcome& first = replayed.result.outcome.moves.front();
  const std::string settled =
      first.arrived ? fmt::format("arrives after {:.4g} s", first.settling_time) : "never arrives";
  std::string caption = fmt::format(
      "Error and $torque over time of trial {} of point {}, simulated again: {}; {}. The error should reach "
      "the dashed line and stay there. Its scale is linear within one count and logarithmic beyond. Samples "
      "are thinned, but all extremes are shown.",
      trial.index, label_of(reported, trial.point),
      replayed.result.outcome.moves.size() == 1 ? settled : "the first move " + settled, ending_of(outcome));
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
