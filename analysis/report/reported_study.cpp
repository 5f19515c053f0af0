#include "analysis/report/reported_study.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "analysis/goal/success_bounds.hpp"
#include "analysis/summary/cells_of_point.hpp"
#include "analysis/summary/chosen_point.hpp"
#include "analysis/summary/point_names.hpp"
#include "analysis/summary/summary.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/quantity.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"

namespace zerocount::report {

namespace {

/// The file with what its summary says, but for the point that the page speaks of.
ReportedStudy summarised(const reading::AllTrialsFile& file) {
  ReportedStudy reported{file, file.study(), summary::summarise(file)};
  reported.bounds_name = reported.study.stop   ? "bounds that hold at whatever trial one stops"
                         : reported.study.rigs ? "Korn-Graubard bounds"
                                               : "Clopper-Pearson bounds";
  for (const measures::PointSummary& one : reported.summary.points)
    reported.success_bounds.push_back(
        goal::bounds_of_chosen(one, 1, reported.summary.question.stopped, statistics::summary_confidence));
  reported.names = summary::short_labels(reported.summary.labels, reported.summary.axes);
  return reported;
}

void add_conditions(ReportedStudy& reported) {
  const std::vector<std::string>& names = reported.study.conditions;
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto file = std::make_shared<const reading::AllTrialsFile>(
        reported.file.under_condition(static_cast<std::int64_t>(i)));
    auto study = std::make_shared<ReportedStudy>(summarised(*file));
    study->chosen = reported.chosen;
    reported.conditions.push_back({names[i], std::move(file), std::move(study)});
  }
  if (names.empty()) return;
  const goal::Question& question = question_of(reported);
  const std::int64_t chosen = reported.chosen.point;
  reported.worst_condition =
      question.claim() ? verdict_on(question, point_of(reported, chosen)).condition
                       : summary::worst_cell(summary::conditions_of_point(reported.summary, chosen));
}

}  // namespace

ReportedStudy reported_study(const reading::AllTrialsFile& file, std::optional<std::int64_t> point) {
  if (point && (*point < 0 || *point >= file.header().points)) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: unknown design point {}; expected 0 to {}",
                                                   file.path().string(), *point, file.header().points - 1));
  }
  ReportedStudy reported = summarised(file);
  reported.chosen = summary::choose_point(reported.summary, point);
  if (!reported.study.open_loop) add_conditions(reported);
  return reported;
}

const ReportedStudy& worst_of_conditions(const ReportedStudy& reported) {
  return has_conditions(reported) ? *reported.conditions[reported.worst_condition].study : reported;
}

std::string worst_condition_text(const ReportedStudy& reported) {
  if (!has_conditions(reported)) return "";
  const bool ages = !question_of(reported).ages.at.empty();
  return fmt::format("{} {}, the worst{}. ", ages ? "At" : "Under",
                     reported.conditions[reported.worst_condition].name, ages ? "" : " condition");
}

std::vector<ReportedPart> parts_of(const ReportedStudy& reported) {
  if (!has_conditions(reported)) return {{"", reported}};
  std::vector<ReportedPart> parts;
  for (const ReportedCondition& one : reported.conditions) parts.push_back({one.name, *one.study});
  return parts;
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

goal::QuestionRate shown_rate(const ReportedStudy& reported, std::int64_t point) {
  return goal::rate_of(question_of(reported), point_of(reported, point));
}

std::string shown_bounds(const ReportedStudy& reported) {
  if (!question_of(reported).claim()) return "95 % " + reported.bounds_name;
  return fmt::format("one-sided {} bounds", text::percent(question_of(reported).claim()->confidence));
}

std::string precision_text(const ReportedStudy& reported, const study::Goal& goal) {
  return goal.tolerance
             ? text::quantity_text(*goal.tolerance, parameters::unit_on(reported.study.units.axis, "rad"))
             : fmt::format("{} count{}", goal.band, goal.band == 1 ? "" : "s");
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
