#include "analysis/report/reported_study.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::report {
namespace {

/// The results file with its summary; which design point the page describes is not chosen yet.
ReportedStudy summarised(const reading::AllTrialsFile& file) {
  ReportedStudy reported{file, file.study(), summary::summarise(file)};
  reported.names = summary::short_labels(reported.summary.labels, reported.summary.axes);
  return reported;
}

void add_settings(ReportedStudy& reported) {
  const study::Settings& settings = reported.study.settings;
  if (settings.empty()) return;
  for (std::int64_t i = 0; i < settings.total(); ++i) {
    auto file = std::make_shared<const reading::AllTrialsFile>(reported.file.in_setting(i));
    auto study = std::make_shared<ReportedStudy>(summarised(*file));
    study->chosen = reported.chosen;
    reported.settings.push_back({study::label_of(settings, i), std::move(file), std::move(study)});
  }
  const goal::Question& question = question_of(reported);
  const std::int64_t chosen = reported.chosen.point;
  reported.worst_setting = question.goal()
                               ? verdict_on(question, point_of(reported, chosen)).setting
                               : summary::worst_cell(summary::settings_of_point(reported.summary, chosen));
}

}  // namespace

ReportedStudy reported_study(const reading::AllTrialsFile& file, std::optional<std::int64_t> point) {
  if (point && (*point < 0 || *point >= file.header().points)) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: unknown design point {}; expected 0 to {}",
                                                   file.path().string(), *point, file.header().points - 1));
  }
  ReportedStudy reported = summarised(file);
  reported.chosen = summary::choose_point(reported.summary, point);
  if (!reported.study.open_loop) add_settings(reported);
  return reported;
}

const ReportedStudy& worst_of_settings(const ReportedStudy& reported) {
  return has_settings(reported) ? *reported.settings[reported.worst_setting].study : reported;
}

std::string worst_setting_phrase(const ReportedStudy& reported) {
  if (!has_settings(reported)) return "";
  const bool ages = !question_of(reported).settings.ages.at.empty();
  return fmt::format("{} {}, the worst{}. ", ages ? "At" : "Under",
                     reported.settings[reported.worst_setting].name, ages ? "" : " condition");
}

std::vector<ReportedPart> parts_of(const ReportedStudy& reported) {
  if (!has_settings(reported)) return {{"", reported}};
  std::vector<ReportedPart> parts;
  for (const ReportedSetting& one : reported.settings) parts.push_back({one.name, *one.study});
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
  if (!question_of(reported).goal())
    return reported.study.stop       ? "95 % bounds that hold at whatever trial one stops"
           : reported.study.machines ? "95 % Korn-Graubard bounds"
                                     : "95 % Clopper-Pearson bounds";
  return fmt::format("one-sided {} bounds", text::percent(question_of(reported).goal()->confidence));
}

std::string precision_text(const ReportedStudy& reported, const study::Goal& goal) {
  return (goal.tolerance
              ? text::quantity_text(*goal.tolerance, parameters::unit_on(reported.study.units.axis, "rad"))
              : fmt::format("{} count{}", goal.band, goal.band == 1 ? "" : "s")) +
         goal::of_mass(goal);
}

layout::RowRange rows_of(const ReportedStudy& reported, std::int64_t point) {
  const std::int64_t trials = reported.file.header().trials;
  return {point * trials, trials};
}

}  // namespace zerocount::report
