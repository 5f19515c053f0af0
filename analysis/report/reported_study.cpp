#include "analysis/report/reported_study.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/best_point.hpp"
#include "analysis/summary/shown_points.hpp"
#include "analysis/summary/summary.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"

namespace zerocount::report {

ReportedStudy reported_study(const reading::StudyFile& file, std::optional<std::int64_t> point) {
  if (point && (*point < 0 || *point >= file.header().points)) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: unknown design point {}; expected 0 to {}",
                                                   file.path().string(), *point, file.header().points - 1));
  }
  ReportedStudy reported{file, layout::recorded_study(file.header(), file.path()), summary::summarise(file)};
  reported.bounds_name = reported.study.stop   ? "bounds that hold at whatever trial one stops"
                         : reported.study.rigs ? "Korn-Graubard bounds"
                                               : "Clopper-Pearson bounds";
  for (const measures::PointSummary& one : reported.summary.points)
    reported.success_bounds.push_back(
        summary::bounds_of_chosen(one, 1, reported.study.stop.has_value(), statistics::summary_confidence));
  reported.chosen = summary::choose_point(reported.summary, point);
  reported.names = summary::short_labels(reported.summary.labels, reported.summary.axes);
  return reported;
}

std::string marked_label_of(const ReportedStudy& reported, std::int64_t point) {
  const bool marked = reported.names.size() > 1 && point == reported.chosen.point;
  return label_of(reported, point) + (marked ? " ★" : "");
}

std::vector<std::int64_t> leading_points(const ReportedStudy& reported) {
  std::vector<std::int64_t> points{reported.chosen.point};
  const auto add = [&](std::int64_t point) {
    if (std::ranges::find(points, point) == points.end()) points.push_back(point);
  };
  add(0);
  if (reported.chosen.runner_up) add(*reported.chosen.runner_up);
  return points;
}

ShownRate shown_rate(const ReportedStudy& reported, std::int64_t point) {
  const measures::PointSummary& summary = point_of(reported, point);
  if (!reported.summary.goal)
    return {summary.success_rate().value, bounds_of(reported, point), summary.outcomes.zero_count,
            summary.trials};
  const goal::Verdict verdict = goal::judge_goal(*reported.summary.goal, *summary.goal, 1);
  const measures::MoveCounts& counts = *summary.goal;
  const measures::MoveCounts shown =
      counts.worlds > 0
          ? measures::in_worlds(counts)[goal::worst_worlds_first(*reported.summary.goal, verdict).front()]
          : counts;
  return {verdict.moves.value, {verdict.moves.low, verdict.moves.high}, shown.met, shown.moves};
}

std::string_view rate_meaning(const ReportedStudy& reported) {
  return reported.summary.goal ? "moves that meet the goal" : "trials that end at zero counts";
}

layout::RowRange rows_of(const ReportedStudy& reported, std::int64_t point) {
  const std::int64_t trials = reported.file.header().trials;
  return {point * trials, trials};
}

std::string axis_title(const study::SweepAxis& axis) {
  if (axis.unit.empty() || axis.unit == "1") return axis.name;
  return fmt::format("{} ({})", axis.name, axis.unit);
}

std::string proportion_text(double proportion) {
  if (proportion == 1.0) return "100 %";
  const double distance = std::min(proportion, 1.0 - proportion);
  const int digits =
      distance > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(distance))) - 1, 1, 9) : 0;
  return fmt::format("{:.{}f} %", 100.0 * proportion, digits);
}

}  // namespace zerocount::report
