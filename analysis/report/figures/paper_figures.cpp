#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/report/figures/report_figures.hpp"
#include "analysis/report/reported_study.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr const char* targets_axis = "command.targets.0";

/// Fig. 7: needs points with one move each that differ only in the target.
bool shows_targets(const ReportedStudy& reported) {
  const std::vector<study::SweepAxis>& axes = reported.summary.axes;
  return axes.size() == 1 && axes[0].name == targets_axis && reported.file.moves() == 1 &&
         !numeric_axes(reported, 3).empty() && axes[0].numbers.size() <= 30;
}

/// Fig. 8: needs one point with one move, and jerks in most trials.
bool shows_jerks(const ReportedStudy& reported) {
  const measures::PointSummary& point = reported.summary.points.front();
  return reported.summary.points.size() == 1 && reported.file.moves() == 1 &&
         point.of(&trial::MoveOutcome::jerk_count).median.value >= 1.0;
}

SampleTrial first_trial(std::int64_t point) {
  return {.name = "first", .point = point};
}

/// The trial with the median number of jerks.
SampleTrial typical_trial(const ReportedStudy& reported) {
  SampleTrial typical = first_trial(0);
  bool found = false;
  measures::visit_trials(
      reported.file, rows_of(reported, 0), [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
        const auto jerks = static_cast<double>(moves.front().jerk_count);
        if (found ||
            jerks != reported.summary.points.front().of(&trial::MoveOutcome::jerk_count).median.value)
          return;
        found = true;
        typical.index = row;
      });
  return typical;
}

using SampleColumn = ColumnOf<trial::SampleRecord>;
using Sample = const trial::SampleRecord&;
const SampleColumn time_column{{"time", "time", "s"}, [](Sample s) { return datum(s.t); }};
const SampleColumn target_column{{"target", "target", "count"}, [](Sample s) { return s.target; }};
const SampleColumn count_column{{"count", "position", "count"}, [](Sample s) { return s.count; }};
const SampleColumn torque_column{{"torque", "$torque", "N m"}, [](Sample s) { return datum(s.torque); }};
const SampleColumn motor_torque_column{{"torque", "$torque", "N m"},
                                       [](Sample s) { return datum(s.drive_torque); }};

Figure step_responses(const std::vector<ReplayedTrial>& replayed) {
  std::vector<trial::SampleRecord> samples;
  for (const ReplayedTrial& trial : replayed)
    samples.insert(samples.end(), trial.samples.begin(), trial.samples.end());
  return figure_of(
      "step-responses", "paper-fig7", "Moves to different targets (Fig. 7 of the paper)",
      "Position over time, one trial for each target, from rest. In the paper all ten moves settle at their "
      "target within 300 samples of 0.5 ms. Every curve should end as a horizontal line at its target.",
      {data_of("samples", samples, {target_column, time_column, count_column})});
}

Figure jerks_in_time(const ReplayedTrial& trial) {
  return figure_of(
      "jerks-in-time", "paper-fig8", "Jerks by creep (Fig. 8 of the paper)",
      fmt::format(
          "Position and $torque over time of trial {}, which has the median number of jerks. After the move "
          "the position repeatedly leaves the target by one count, always in the direction of the holding "
          "$torque, and returns at once. The rate of these jerks decreases as the contact hardens.",
          trial.result.row),
      {data_of("samples", trial.samples, {time_column, count_column, torque_column})});
}

/// The ends of the torque levels. Levels that end at the same point share a row.
/// @param field and @param title of the column of places
FigureData level_ends(const ReplayedTrial& trial, const char* field, const char* title,
                      double trial::MoveOutcome::*place) {
  FigureData data{"levels", {{"levels", "levels", ""}, {field, title, "µrad"}, {"torque", "$torque", "N m"}}};
  const std::vector<trial::MoveOutcome>& levels = trial.result.outcome.moves;
  double reach = 0.0;
  for (const trial::MoveOutcome& level : levels) reach = std::max(reach, std::abs(1e6 * (level.*place)));
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double end = 1e6 * (levels[i].*place);
    const std::string name = fmt::format("{}", i + 1);
    const auto shared = std::find_if(data.rows.begin(), data.rows.end(), [&](const ordered_json& row) {
      return std::abs(row[1].get<double>() - end) <= 0.01 * reach &&
             std::abs(row[2].get<double>() - levels[i].holding_torque) <= 1e-6;
    });
    if (shared == data.rows.end()) {
      data.rows.push_back(ordered_json::array({name, datum(end), datum(levels[i].holding_torque)}));
    } else {
      (*shared)[0] = (*shared)[0].get<std::string>() + ", " + name;
    }
  }
  return data;
}

Figure hysteresis(const ReplayedTrial& trial, bool creeping) {
  const SampleColumn angle{{"angle", "$rotor_angle", "µrad"}, [](Sample s) { return datum(1e6 * s.theta); }};
  return figure_of(
      "hysteresis", "paper-fig4", "$Torque over $angle (Fig. 4 of the paper)",
      fmt::format("$Torque over $rotor_angle of trial {}, loaded and unloaded. Each number marks "
                  "the end of a $torque level, in their order. {}",
                  trial.result.row,
                  creeping ? "Creep moves the $rotor on while the $torque is held, so a loop does "
                             "not close where the contact has crept in it."
                           : "The spring has hysteresis with return-point memory: loops between "
                             "the same $torques have the same width, and a closed loop has no "
                             "further influence, so levels of equal $torque end at the same "
                             "point."),
      {data_of("samples", trial.samples, {time_column, angle, motor_torque_column}),
       level_ends(trial, "angle", "$rotor_angle", &trial::MoveOutcome::final_position)});
}

Figure plastic_extension(const ReplayedTrial& trial) {
  const SampleColumn extension{{"extension", "plastic extension", "µrad"},
                               [](Sample s) { return datum(1e6 * s.xp); }};
  return figure_of(
      "creep", "paper-fig6", "$Torque over plastic extension (Fig. 6 of the paper)",
      fmt::format(
          "$Torque over plastic (creep) extension of trial {}. Each number marks the end of a $torque "
          "level, in their order. At constant $torque the contact creeps along a horizontal line "
          "until it has hardened. A repeated or smaller $torque of either sign adds no extension.",
          trial.result.row),
      {data_of("samples", trial.samples, {time_column, extension, motor_torque_column}),
       level_ends(trial, "extension", "plastic extension", &trial::MoveOutcome::creep)});
}

/// Whether the contact of the first trial creeps.
bool creeps(const ReportedStudy& reported) {
  const trial::TrialParameters parameters = study::study_trial(reported.study, 0, 0).parameters;
  return friction::has_creep(parameters.friction.model) &&
         friction::friction_at(parameters.friction, parameters.initial.position).alpha > 0.0;
}

}  // namespace

std::vector<PaperFigure> paper_figures(const ReportedStudy& reported) {
  if (reported.study.open_loop) {
    SampleTrial trial = first_trial(0);
    trial.buckets = 2000;
    std::vector<PaperFigure> figures{{"paper-fig4", {trial}}};
    if (creeps(reported)) figures.push_back({"paper-fig6", {trial}});
    return figures;
  }
  if (shows_targets(reported)) {
    PaperFigure figure{"paper-fig7"};
    for (std::size_t point = 0; point < reported.summary.points.size(); ++point)
      figure.trials.push_back(first_trial(static_cast<std::int64_t>(point)));
    return {figure};
  }
  if (shows_jerks(reported)) return {{"paper-fig8", {typical_trial(reported)}}};
  return {};
}

Figure paper_figure(const ReportedStudy& reported, const PaperFigure& wanted,
                    const std::vector<ReplayedTrial>& replayed) {
  if (wanted.name == "paper-fig7") return step_responses(replayed);
  if (wanted.name == "paper-fig8") return jerks_in_time(replayed.front());
  return wanted.name == "paper-fig4" ? hysteresis(replayed.front(), creeps(reported))
                                     : plastic_extension(replayed.front());
}

}  // namespace zerocount::report
