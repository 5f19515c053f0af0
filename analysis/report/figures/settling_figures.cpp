#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/basis/statistics/sums/histogram.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/report/figures/report_figures.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question_text.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "experiments/study/setting_study.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

/// Largest number of curves of a figure. With settings (conditions at ages) there is at least one curve for
/// each.
constexpr std::int64_t max_curves = 6;
/// Largest number of steps that a curve of a distribution function has.
constexpr std::int64_t max_steps = 160;

/// Half-width of the simultaneous confidence band of a distribution function: √(ln(2M/α)/2n) for n
/// independent clusters (trials or machines) of M dependent moves each. (Dvoretzky, Kiefer and Wolfowitz 1956
/// with the constant of Massart 1990, for each of the M moves at the level α/M; the mean of M functions that
/// are each within the band is so too.)
double band_of(const ReportedStudy& reported, const measures::PointSummary& point) {
  const std::int64_t clusters = reported.study.machines > 0 ? reported.study.machines : point.trials;
  const std::int64_t moves = point.moves / clusters;
  const double alpha = 1.0 - statistics::summary_confidence;
  return std::sqrt(std::log(2.0 * static_cast<double>(moves) / alpha) /
                   (2.0 * static_cast<double>(clusters)));
}

/// Numbers of moves that a goal judges, and the times from which they are settled.
struct SettledMoves {
  statistics::Histogram<double> times{};
  std::int64_t asked{0};
};

/// Settling time of a move, s. NaN if the move does not settle, nothing if it is not judged.
using SettlingTime = std::function<std::optional<double>(const trial::MoveOutcome&)>;

/// [world] Judged moves of a point, divided by the world of the trial; a single element without worlds.
/// @param worlds number of worlds; 1 without worlds
std::vector<SettledMoves> settled_by_world(const ReportedStudy& reported, std::int64_t point,
                                           std::size_t worlds, const SettlingTime& time) {
  std::vector<SettledMoves> settled(worlds);
  const layout::RowRange rows = rows_of(reported, point);
  measures::visit_trials(
      reported.file, rows, [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
        const std::int64_t world =
            worlds == 1 ? 0 : study::group_of(reported.study, study::Grouping::world, row - rows.first);
        SettledMoves& of_world = settled[static_cast<std::size_t>(world)];
        for (const trial::MoveOutcome& move : moves) {
          const std::optional<double> found = time(move);
          if (!found) continue;
          ++of_world.asked;
          if (!std::isnan(*found)) of_world.times.add(*found);
        }
      });
  return settled;
}

/// Function that gives the settling time of a move for a goal. The time counts from the same instant as the
/// goal's time limit: the start of the move, or the end of its motion profile.
SettlingTime time_in(const measures::MoveCriterion& goal) {
  return [&goal](const trial::MoveOutcome& move) -> std::optional<double> {
    if (!measures::asks(goal, move)) return std::nullopt;
    const double time = measures::settling_time(goal, move);
    return goal.within.after_profile ? std::max(time - move.travel_time, 0.0) : time;  // NaN stays
  };
}

std::optional<double> arrival_time(const trial::MoveOutcome& move) {
  return move.arrived ? move.arrival_time : std::nan("");
}

/// The latest settling time of the moves, s; 0 if no move settles.
double end_of(const SettledMoves& moves) {
  return moves.times.size > 0 ? statistics::largest(moves.times) : 0.0;
}

/// The distribution function of the settling times as steps {time in s, proportion of judged moves}, from 0
/// to the last time.
/// @param most approximate largest number of steps
std::vector<std::pair<double, double>> steps_of(const SettledMoves& moves, std::int64_t most) {
  std::vector<std::pair<double, double>> steps{{0.0, 0.0}};
  std::int64_t settled = 0;
  std::int64_t shown = 0;
  for (const auto& [time, count] : moves.times.counts) {
    settled += count;
    if (settled < moves.times.size && (settled - shown) * most < moves.times.size) continue;
    steps.emplace_back(time, static_cast<double>(settled) / static_cast<double>(moves.asked));
    shown = settled;
  }
  return steps;
}

const measures::MeasureStatistics& settling_of(const ReportedStudy& reported, std::int64_t point) {
  return point_of(reported, point).of(&trial::MoveOutcome::arrival_time);
}

/// Indices of the design points with a curve: those in which moves arrive. If there are too many, evenly
/// spaced ones from the best to the worst are taken, and the nearest of them are replaced by
/// leading_points().
std::vector<std::int64_t> points_with_curves(const ReportedStudy& reported) {
  const std::int64_t most =
      std::max<std::int64_t>(max_curves / std::max<std::int64_t>(std::ssize(reported.settings), 1), 1);
  std::vector<std::int64_t> with_arrivals;
  const auto& points = reported.summary.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].of(&trial::MoveOutcome::arrival_time).n > 0)
      with_arrivals.push_back(static_cast<std::int64_t>(i));
  }
  if (std::ssize(with_arrivals) <= most) return with_arrivals;
  std::stable_sort(with_arrivals.begin(), with_arrivals.end(), [&](std::int64_t a, std::int64_t b) {
    return settling_of(reported, a).n > settling_of(reported, b).n;
  });
  std::vector<std::int64_t> shown;
  for (const std::int64_t point : leading_points(reported)) {
    if (settling_of(reported, point).n > 0 && std::ssize(shown) < most) shown.push_back(point);
  }
  for (const std::int64_t i : statistics::spread_over(std::ssize(with_arrivals), most)) {
    const std::int64_t point = with_arrivals[static_cast<std::size_t>(i)];
    if (std::ssize(shown) < most && std::ranges::find(shown, point) == shown.end()) shown.push_back(point);
  }
  std::sort(shown.begin(), shown.end());
  return shown;
}

/// Adds to the dataset the distribution curve of settling times with its confidence band. Both continue to
/// the time `end`, s.
/// @param half_width half-width of the band, a proportion of moves
void add_curve(FigureData& data, const std::string& label, const SettledMoves& moves, double half_width,
               double end) {
  std::vector<std::pair<double, double>> steps = steps_of(moves, max_steps);
  if (moves.times.size == 0 || end_of(moves) < end) steps.emplace_back(end, steps.back().second);
  for (const auto& [time, proportion] : steps)
    data.rows.push_back({label, datum(time), datum(proportion), datum(std::max(0.0, proportion - half_width)),
                         datum(std::min(1.0, proportion + half_width))});
}

/// Label of a curve: "kp=400, loaded"; "loaded" if the study has one point.
std::string label_of_curve(const ReportedStudy& reported, const ReportedPart& part, std::int64_t point) {
  return has_settings(reported) && reported.names.size() == 1
             ? part.setting
             : study::label_under(marked_label_of(reported, point), part.setting);
}

/// Sentence on the confidence of the bands about the curves, and on the number of trials behind them.
std::string bands_sentence(const ReportedStudy& reported) {
  const std::int64_t moves = reported.file.moves();
  return fmt::format(
      "The bands {} (Dvoretzky-Kiefer-Wolfowitz, n = {}{}): they are wider than the bounds at one time. ",
      reported.summary.features.dependent_trials
          ? "would contain the whole curve of a point with 95 % confidence if its trials were independent"
          : "contain the whole curve of a point with 95 % confidence",
      reported.study.machines > 0 ? fmt::format("{} machines", reported.study.machines)
                                  : fmt::format("{} trials", study::draw_count(reported.study)),
      reported.study.machines == 0 && moves > 1 ? fmt::format(" of {} moves each", moves) : "");
}

std::optional<Figure> arrival_figure(const ReportedStudy& reported) {
  const std::vector<std::int64_t> shown = points_with_curves(reported);
  if (shown.empty()) return std::nullopt;
  const auto& points = reported.summary.points;
  std::string caption =
      "Proportion of all moves of a point that have arrived by a time: their error was first 0 for the whole "
      "dwell (also if they left the target later). A curve that ends below 100 % has moves that never "
      "arrived. " +
      bands_sentence(reported);
  const auto arriving = std::count_if(points.begin(), points.end(), [](const measures::PointSummary& point) {
    return point.of(&trial::MoveOutcome::arrival_time).n > 0;
  });
  if (std::ssize(shown) < arriving) {
    caption += fmt::format("Shown are {} of {} points: the chosen one{}. ", shown.size(), arriving,
                           shown.size() == 1 ? "" : ", the first, the runner-up, and others");
  }
  if (arriving < std::ssize(points))
    caption +=
        fmt::format("At {} of the {} points no move arrived. ", std::ssize(points) - arriving, points.size());
  FigureData data{"steps",
                  {{"label", "point", ""},
                   {"time", "arrived by", "s"},
                   {"share", "proportion of moves", "1"},
                   {"low", "lower 95 % bound", "1"},
                   {"high", "upper 95 % bound", "1"}}};
  double end = 0.0;
  double start = std::numeric_limits<double>::infinity();
  for (const std::int64_t point : shown) {
    end = std::max(end, settling_of(reported, point).max);
    start = std::min(start, settling_of(reported, point).median.value);
  }
  for (const std::int64_t point : shown) {
    for (const ReportedPart& part : parts_of(reported)) {
      const measures::PointSummary& summary = point_of(part.study, point);
      const std::vector<SettledMoves> moves = settled_by_world(part.study, point, 1, arrival_time);
      add_curve(data, label_of_curve(reported, part, point), moves.front(), band_of(part.study, summary),
                end);
    }
  }
  Figure figure = figure_of("settling-time", "settling-time", "How soon do the moves arrive?", caption,
                            {std::move(data)});
  if (start > 0.0 && end > 12.0 * start) {  // otherwise a few late arrivals would compress all others
    figure.parameters = {{"scale", "symlog"}, {"constant", start / 4.0}};
    figure.caption += "The time axis is linear near zero and logarithmic beyond.";
  }
  return figure;
}

/// A goal or an error band in which moves settle, whose settling times a figure shows.
struct SettledSubject {
  std::string name;       ///< Name of the goal, or of the band: "±1 count".
  std::string precision;  ///< Precision as text: "1 count", "10 nm".
  /// Selects the judged moves, and the band or tolerance in which they settle.
  measures::MoveCriterion criterion;
  /// Goal whose limits of time and proportion are drawn as lines; nothing for an error band without a goal.
  std::optional<study::Goal> goal{};
};

std::vector<SettledSubject> settled_subjects(const ReportedStudy& reported) {
  const goal::Question& question = question_of(reported);
  std::vector<SettledSubject> subjects;
  if (question.goal()) {
    for (const goal::JudgedCriterion& part : question.parts)
      subjects.push_back({part.goal->name, precision_text(reported, *part.goal), part.criterion, part.goal});
    return subjects;
  }
  const trial::ErrorBands& bands = reported.study.features.bands;
  for (std::size_t slot = 0; slot < bands.count; ++slot) {
    const std::string precision = precision_text(reported, {.band = bands.values()[slot]});
    subjects.push_back({"±" + precision, precision, {.settling = measures::Settling::in_band, .slot = slot}});
  }
  return subjects;
}

/// Adds to the dataset the curves of a goal or error band, one for each setting; returns whether any move
/// settles.
bool add_settled(FigureData& data, const ReportedStudy& reported, const SettledSubject& subject) {
  std::vector<SettledMoves> settled;
  const std::vector<ReportedPart> parts = parts_of(reported);
  const std::int64_t chosen = reported.chosen.point;
  double end = 0.0;
  for (const ReportedPart& part : parts) {
    settled.push_back(settled_by_world(part.study, chosen, 1, time_in(subject.criterion)).front());
    end = std::max(end, end_of(settled.back()));
  }
  if (end == 0.0) return false;
  if (subject.goal) end = std::max(end, subject.goal->within.time);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t first = data.rows.size();
    add_curve(data, has_settings(reported) ? parts[i].setting : subject.name, settled[i],
              band_of(parts[i].study, point_of(parts[i].study, chosen)), end);
    for (std::size_t row = first; row < data.rows.size(); ++row) data.rows[row].push_back(subject.name);
  }
  return true;
}

/// Adds the goals' time limits and required proportions of moves to the figure, as straight lines across it.
void add_goals(Figure& figure, const std::vector<SettledSubject>& subjects) {
  FigureData goals{"goals",
                   {{"within", "within", "s"}, {"moves", "proportion of moves", "1"}, {"subject", "", ""}}};
  for (const SettledSubject& one : subjects)
    if (one.goal) goals.rows.push_back({one.goal->within.time, one.goal->moves, one.name});
  if (!goals.rows.empty()) figure.data.push_back(std::move(goals));
}

/// A goal as text: "large: ±10 nm after 30 ms in 95 % of the moves".
std::string goal_text(const SettledSubject& subject) {
  const study::TimeLimit& within = subject.goal->within;
  return fmt::format("{}{}±{} {} in {} of the moves", subject.name, subject.name.empty() ? "" : ": ",
                     subject.precision, goal::after_text(within, text::quantity_text(within.time, "s")),
                     text::percent(subject.goal->moves));
}

/// Figure with a curve of settling times for each goal, or error band, and each setting (condition at an
/// age). Goals, and bands if there are settings, have panels of their own.
std::optional<Figure> settled_figure(const ReportedStudy& reported) {
  FigureData data{"steps",
                  {{"label", has_settings(reported) ? "condition" : "of", ""},
                   {"time", "settled for good from", "s"},
                   {"share", "proportion of moves", "1"},
                   {"low", "lower 95 % bound", "1"},
                   {"high", "upper 95 % bound", "1"},
                   {"subject", has_settings(reported) ? "goal or band" : "", ""}}};
  std::vector<SettledSubject> subjects = settled_subjects(reported);
  std::erase_if(subjects, [&](const SettledSubject& one) { return !add_settled(data, reported, one); });
  if (subjects.empty()) return std::nullopt;
  const bool with_goal = subjects.front().goal.has_value();
  const bool with_limits =
      std::ranges::any_of(subjects, [](const SettledSubject& one) { return !one.criterion.limits.empty(); });
  std::string caption = fmt::format(
      "Proportion of the moves of {} whose error stays within ±{} from a time on to the end of the move{}. ",
      label_of(reported, reported.chosen.point), subjects.size() == 1 ? subjects.front().precision : "b",
      has_settings(reported) ? ", under each condition" : "");
  caption += bands_sentence(reported);
  if (with_goal) caption += "The dashed lines are the goal: the curve must pass above their crossing. ";
  if (with_goal && subjects.size() == 1) caption += fmt::format("It asks {}. ", goal_text(subjects.front()));
  if (!with_goal) caption += "Shortly before the end there is little time left to leave a band in. ";
  if (std::ranges::any_of(subjects, [](const auto& one) { return one.criterion.within.after_profile; }))
    caption += "Where a goal counts from the end of the profile, so do the times. ";
  if (with_limits) caption += "The limits of the goal are not in it. ";
  if (reported.study.worlds > 0) caption += "It is an average over the worlds. ";
  Figure figure =
      figure_of("settling-time", "settled",
                subjects.size() == 1
                    ? fmt::format("How soon are the moves within ±{} for good?", subjects.front().precision)
                    : fmt::format("How soon are the moves within {} for good?",
                                  with_goal ? "what each goal asks" : "each band"),
                caption, {std::move(data)});
  add_goals(figure, subjects);
  if (!has_settings(reported) && !with_goal) return figure;
  figure.parameters["panels"] = "subject";
  for (const SettledSubject& one : subjects)
    if (one.goal) figure.parameters["titles"][one.name] = goal_text(one);
  return figure;
}

}  // namespace

std::vector<Figure> distribution_figures(const ReportedStudy& reported) {
  std::vector<Figure> figures;
  const auto add = [&](std::optional<Figure> figure) {
    if (figure) figures.push_back(std::move(*figure));
  };
  if (!question_of(reported).goal()) add(arrival_figure(reported));
  if (!reported.study.open_loop) add(settled_figure(reported));
  return figures;
}

namespace {

constexpr std::size_t max_parameters = 6;
/// Largest number of worlds (draws of what all machines share) that have a curve.
constexpr std::size_t max_world_curves = 200;
/// Largest number of steps of the distribution curve of a world.
constexpr std::int64_t max_world_steps = 80;

/// Index of the world parameter in the first condition of the rule that separates good worlds from bad ones;
/// 0 (the first parameter) without a rule.
std::size_t leading_input(const worlds::PointWorlds& point) {
  return point.rule ? point.rule->conditions.front().input : 0;
}

/// Figure with one distribution curve of settling times for each world, a draw of what all machines share and
/// nobody knows.
std::optional<Figure> curves_figure(const ReportedStudy& reported, const worlds::PointWorlds& point) {
  const goal::Question& question = reported.summary.question;
  if (!question.goal() && reported.study.features.bands.count == 0) return std::nullopt;
  const std::vector<worlds::WorldInput>& inputs =
      summary::world_inputs_of(reported.summary, reported.chosen.point);
  const measures::MoveCriterion goal = question.goal()
                                           ? question.criterion()
                                           : measures::MoveCriterion{.settling = measures::Settling::in_band};
  const std::vector<SettledMoves> moves = settled_by_world(
      reported, reported.chosen.point, static_cast<std::size_t>(reported.study.worlds), time_in(goal));
  double end = question.goal() ? question.goal()->within.time : 0.0;
  for (const SettledMoves& one : moves) end = std::max(end, end_of(one));
  const bool colours = !inputs.empty();
  const std::size_t input = leading_input(point);
  const std::string parameter = colours ? inputs[input].name : std::string("world");
  FigureData data{"steps",
                  {{"world", "world", ""},
                   {"time", "within the band for good from", "s"},
                   {"share", "proportion of moves", "1"},
                   {"bad", "bad world", ""},
                   {"value", parameter, colours ? inputs[input].unit : "1"}}};
  for (std::size_t world = 0; world < std::min(moves.size(), max_world_curves); ++world) {
    std::vector<std::pair<double, double>> steps = steps_of(moves[world], max_world_steps);
    steps.emplace_back(end, steps.back().second);
    for (const auto& [time, proportion] : steps)
      data.rows.push_back({world, datum(time), datum(proportion), static_cast<bool>(point.bad[world]),
                           datum(colours ? inputs[input].values[world] : static_cast<double>(world))});
  }
  Figure figure = figure_of(
      "world-curves", "worlds", "How soon do the moves of each world settle?",
      fmt::format(
          "Proportion of the moves of each world, at {}, whose error stays within ±{} from a time "
          "on. {}. Bad worlds are coloured by {}{}.",
          label_of(reported, reported.chosen.point),
          precision_text(reported, question.goal()
                                       ? *question.goal()
                                       : study::Goal{.band = reported.study.features.bands.values()[0]}),
          summary::bad_worlds_sentence(point, inputs, reported.summary.question), parameter,
          moves.size() > max_world_curves ? fmt::format("; shown are the first {}", max_world_curves) : ""),
      {std::move(data)});
  if (question.goal())
    figure.parameters["asked"] = {
        {{"within", question.goal()->within.time}, {"moves", question.goal()->moves}}};
  return figure;
}

/// Figure of the rate (success or goal) in each world over a parameter that differs between worlds.
/// @param input index of this parameter
Figure rate_figure(const ReportedStudy& reported, const worlds::PointWorlds& point, std::size_t input) {
  const worlds::WorldInput& parameter =
      summary::world_inputs_of(reported.summary, reported.chosen.point)[input];
  FigureData data{"worlds",
                  {{"world", "world", ""},
                   {"value", parameter.name, parameter.unit},
                   {"rate", "rate", "1"},
                   {"low", "lower bound", "1"},
                   {"high", "upper bound", "1"},
                   {"kind", "kind", ""}}};
  for (std::size_t world = 0; world < point.bad.size(); ++world) {
    const goal::BoundedProportion& rate = point.asked.worlds[world];
    data.rows.push_back(
        ordered_json::array({world, datum(parameter.values[world]), datum(rate.value), datum(rate.low),
                             datum(rate.high), point.bad[world] ? "bad world" : "other world"}));
  }
  Figure figure =
      figure_of("world-rate", fmt::format("world-rate-{}", input + 1),
                fmt::format("Does {} decide whether a world is good?", parameter.name),
                fmt::format("Proportion of the {} in each world, at {}, with one-sided bounds {}.",
                            goal::noun_of_judged_rate(reported.summary.question),
                            label_of(reported, reported.chosen.point),
                            point.goal ? "which all hold together with the confidence of the goal"
                                       : "each world alone, with 95 % confidence"),
                {std::move(data)});
  const auto [least, largest] = std::ranges::minmax(parameter.values);
  if (least > 0.0 && largest > 5.0 * least) figure.parameters["scale"] = "log";
  if (const std::optional<study::Goal>& claim = reported.summary.question.goal())
    figure.parameters["asked"] = {{{"rate", study::demanded_proportion(*claim)}}};
  return figure;
}

}  // namespace

std::vector<Figure> world_figures(const ReportedStudy& reported) {
  std::vector<Figure> figures;
  const summary::StudySummary& study = reported.summary;
  const std::optional<worlds::PointWorlds> found = summary::worlds_of_point(study, reported.chosen.point);
  if (!found) return figures;
  const worlds::PointWorlds& point = *found;
  if (std::optional<Figure> curves = curves_figure(reported, point)) figures.push_back(std::move(*curves));
  const std::size_t inputs = summary::world_inputs_of(study, reported.chosen.point).size();
  for (std::size_t input = 0; input < std::min(inputs, max_parameters); ++input)
    figures.push_back(rate_figure(reported, point, input));
  return figures;
}

}  // namespace zerocount::report
