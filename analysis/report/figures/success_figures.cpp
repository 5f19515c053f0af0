#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <fmt/format.h>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/report/figures/report_figures.hpp"
#include "analysis/trials/goal/question_text.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "analysis/trials/theory/curves.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/study/setting_study.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

/// Largest number of design points that have a row or line of their own.
constexpr std::int64_t max_lines = 60;
constexpr std::int64_t max_series = 8;  ///< Largest number of lines in one panel: the number of colours.

/// Results that have a row or line of their own in a figure: those for one goal in one setting (condition at
/// an age).
struct ShownLine {
  std::string goal;     ///< Name of the goal; empty unless the study has several goals.
  std::string setting;  ///< Name of the setting (condition at an age); empty without settings.
  const ReportedStudy& study;
  goal::Question question;

  /// Proportion of machines or moves that meet the goal; without a goal, proportion of successful trials.
  goal::QuestionRate rate(std::int64_t point) const {
    const measures::PointSummary& shown = point_of(study, point);
    if (!goal::is_of_machines(question)) return goal::rate_of(question, shown);
    const goal::Verdict verdict = verdict_on(question, shown);
    goal::QuestionRate rate{verdict.machines.value,
                            {verdict.machines.low, verdict.machines.high},
                            verdict.machines_meeting,
                            shown.goals.front().shape().machines};
    if (verdict.worlds.empty()) return rate;
    const std::size_t world = goal::worst_worlds_first(*question.goal(), verdict).front();
    rate.hits = verdict.worlds[world].machines_meeting;
    rate.events = std::ssize(shown.goals[question.parts.front().number].sum({.world = world}).machines);
    return rate;
  }
  /// Proportion that the goal requires; null without a goal.
  ordered_json asked() const {
    if (!question.goal()) return nullptr;
    return study::demanded_proportion(*question.goal());
  }
};

std::vector<ShownLine> shown_lines(const ReportedStudy& reported) {
  std::vector<ShownLine> lines;
  for (const goal::JudgedCriterion& part : question_of(reported).parts) {
    for (const ReportedPart& one : parts_of(reported)) {
      lines.push_back({has_several(question_of(reported)) ? part.goal->name : "", one.setting, one.study,
                       only(question_of(one.study), part.number)});
    }
  }
  return lines;
}

/// Words for the quantities that a figure of success rates shows.
struct RateWords {
  std::string rate;     ///< Rate, such as "proportion of machines that meet the goal".
  std::string hits;     ///< Counted successes, such as "machines in goal".
  std::string events;   ///< Counted objects, such as "machines".
  std::string meeting;  ///< Successful objects, such as "machines that meet the goal".
};

RateWords words_of_rate(const ReportedStudy& reported) {
  const goal::Question& question = question_of(reported);
  const auto of_machines = [](const goal::JudgedCriterion& part) { return part.goal && part.goal->machines; };
  if (std::ranges::none_of(question.parts, of_machines))
    return question.goal()
               ? RateWords{"rate of moves in goal", "moves in goal", "moves", "moves that meet the goal"}
               : RateWords{"success rate", "successes", "trials", meeting_noun(question)};
  if (std::ranges::all_of(question.parts, of_machines))
    return {"proportion of machines that meet the goal", "machines in goal", "machines",
            "machines that meet the goal in its proportion of moves"};
  return {"proportion that the goal is about", "in goal", "of", "machines, or moves, that meet the goal"};
}

/// Label of a row or line in a figure: "kp=400 ★, large, loaded"; "large, loaded" if the study has one design
/// point.
/// @param with_goal whether the goals have no panels of their own
std::string label_of_line(const ReportedStudy& reported, std::int64_t point, const ShownLine& line,
                          bool with_goal) {
  const bool alone = reported.names.size() == 1;
  std::string label = alone ? "" : marked_label_of(reported, point);
  for (const std::string& part : {with_goal ? line.goal : std::string(), line.setting})
    if (!part.empty()) label += (label.empty() ? "" : ", ") + part;
  return label.empty() ? label_of(reported, point) : label;
}

FigureData rates_data(const RateWords& words) {
  return {"points",
          {{"label", "point", ""},
           {"rate", words.rate, "1"},
           {"low", "lower bound", "1"},
           {"high", "upper bound", "1"},
           {"successes", words.hits, "1"},
           {"trials", words.events, "1"},
           {"asked", "asked for", "1"},
           {"condition", "", ""},
           {"goal", "", ""}}};
}

ordered_json row_of(const std::string& label, const ShownLine& line, const goal::QuestionRate& rate) {
  return ordered_json::array({label, datum(rate.value), datum(rate.bounds.low), datum(rate.bounds.high),
                              rate.hits, rate.events, line.asked(), line.setting, line.goal});
}

/// Caption text on the required rate and the bounds.
/// @param line what shows the required rate, "dark", and what shows the bounds, "bars"
std::string bounds_note(const ReportedStudy& reported, std::string_view line, std::string_view bounds) {
  return fmt::format(
      "{}The {} are {}, for each point separately.",
      question_of(reported).goal() ? fmt::format("The {} line is what the goal asks for. ", line) : "",
      bounds, shown_bounds(reported));
}

/// Indices of the design points by decreasing rate of success; if there are too many, evenly spaced ones of
/// that order.
/// @param lines_of_each number of rows or lines that each point takes
std::vector<std::int64_t> points_with_lines(const ReportedStudy& reported, std::int64_t lines_of_each) {
  std::vector<std::int64_t> order(reported.summary.points.size());
  std::iota(order.begin(), order.end(), std::int64_t{0});
  const std::int64_t most = std::max<std::int64_t>(max_lines / lines_of_each, 1);
  if (std::ssize(order) <= most) return order;
  std::stable_sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) {
    return shown_rate(reported, a).value > shown_rate(reported, b).value;
  });
  std::vector<std::int64_t> shown;
  const std::vector<std::int64_t> leading = leading_points(reported);
  const std::vector<std::int64_t> spread = statistics::spread_over(std::ssize(order), most);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool wanted = std::ranges::binary_search(spread, static_cast<std::int64_t>(i)) ||
                        std::ranges::find(leading, order[i]) != leading.end();
    if (wanted) shown.push_back(order[i]);
  }
  return shown;
}

/// Figure with a row for each design point in each setting (condition at an age): its success rate with
/// bounds.
Figure row_per_point(const ReportedStudy& reported) {
  const std::vector<ShownLine> lines = shown_lines(reported);
  const bool alone = reported.names.size() == 1;
  const std::vector<std::int64_t> shown = points_with_lines(reported, std::ssize(parts_of(reported)));
  const goal::Question& question = question_of(reported);
  const RateWords words = words_of_rate(reported);
  std::string caption =
      fmt::format("Proportion of the {}{}{}{}. ", words.meeting, alone ? "" : ", of all of each point",
                  has_settings(reported) ? ", under each condition" : "",
                  goal::is_of_worst_world(question) ? ", in its worst world" : "");
  if (!reported.summary.features.dependent_trials) {
    if (!alone) caption += "Points whose bounds do not overlap differ significantly. ";
    caption +=
        "A dot at 100 % does not exclude failures: their probability may be up to 100 % minus the lower "
        "bound. ";
  }
  if (std::ssize(shown) < std::ssize(reported.summary.points)) {
    caption += fmt::format("Shown are {} of {} points, evenly spaced from the best to the worst. ",
                           shown.size(), reported.summary.points.size());
  }
  FigureData data = rates_data(words);
  for (const std::int64_t point : shown) {
    for (const ShownLine& line : lines)
      data.rows.push_back(row_of(label_of_line(reported, point, line, alone), line, line.rate(point)));
  }
  const char* const title = !question.goal()         ? "How many trials succeed?"
                            : !alone                 ? "Which design points meet the goal?"
                            : has_settings(reported) ? "Is the goal met under each condition?"
                                                     : "Is the goal met?";
  Figure figure = figure_of("success", "success", title, caption + bounds_note(reported, "dark", "bars"),
                            {std::move(data)});
  if (!alone) figure.parameters["panels"] = "goal";
  return figure;
}

/// Title of the axis of a swept parameter, with its unit: "controller.ki (N m/count)".
std::string axis_title(const study::SweepAxis& axis) {
  if (axis.unit.empty() || axis.unit == "1") return axis.name;
  return fmt::format("{} ({})", axis.name, axis.unit);
}

/// Indices of the groups of design points to show, at most `most`, evenly spaced. The shown group nearest to
/// that of the chosen point is replaced by it.
std::vector<std::int64_t> groups_shown(const ReportedStudy& reported, const std::vector<PointGroup>& groups,
                                       std::int64_t most) {
  std::vector<std::int64_t> shown = statistics::spread_over(std::ssize(groups), most);
  const auto chosen = std::ranges::find_if(groups, [&](const PointGroup& group) {
    return std::ranges::find(group.points, reported.chosen.point) != group.points.end();
  });
  const std::int64_t wanted = chosen - groups.begin();
  *std::ranges::min_element(shown, {}, [&](std::int64_t group) { return std::abs(group - wanted); }) = wanted;
  return shown;
}

Figure along_axis(const ReportedStudy& reported, std::size_t axis) {
  const study::SweepAxis& swept = reported.summary.axes[axis];
  const std::vector<ShownLine> lines = shown_lines(reported);
  const auto settings = std::ssize(parts_of(reported));
  const RateWords words = words_of_rate(reported);
  const std::vector<PointGroup> groups = groups_along(reported, {axis});
  const std::int64_t most = std::max<std::int64_t>(max_series / settings, 1);
  const char* const each = has_settings(reported) ? " under each condition" : "";
  std::string caption = fmt::format(
      "Proportion of the {}, of all of each point{} (line), over {}. A star marks the chosen point. ",
      words.meeting, each, axis_title(swept));
  if (std::ssize(groups) > most) {
    caption += fmt::format("Shown are {} of {} lines{}: that of the chosen point, and others evenly spaced. ",
                           most, groups.size(), each);
  }
  FigureData data = rates_data(words);
  data.columns.push_back({"x", swept.name, swept.unit});
  data.columns.push_back({"series", "", ""});
  for (const std::int64_t shown : groups_shown(reported, groups, most)) {
    const PointGroup& group = groups[static_cast<std::size_t>(shown)];
    for (const ShownLine& line : lines) {
      for (const std::int64_t point : group.points) {
        ordered_json row = row_of(label_of_line(reported, point, line, false), line, line.rate(point));
        row.push_back(swept.numbers[static_cast<std::size_t>(point)]);
        row.push_back(group.label.empty() ? line.setting : study::label_under(group.label, line.setting));
        data.rows.push_back(std::move(row));
      }
    }
  }
  Figure figure =
      figure_of("success-along", "success",
                question_of(reported).goal() ? fmt::format("At which {} is the goal met?", swept.name)
                                             : fmt::format("How does success depend on {}?", swept.name),
                caption + bounds_note(reported, "dashed", "bands"), {std::move(data)});
  const std::vector<double> values = values_of(swept);
  figure.parameters["scale"] = spaced_by_ratio(values) ? "log" : "linear";
  figure.parameters["domain"] = {values.front(), values.back()};
  return figure;
}

}  // namespace

std::optional<Figure> success_figure(const ReportedStudy& reported) {
  if (reported.study.open_loop) return std::nullopt;
  const std::vector<std::size_t> numeric = numeric_axes(reported, 3);
  return numeric.empty() ? row_per_point(reported) : along_axis(reported, numeric.front());
}

namespace {

constexpr std::int64_t max_maps = 4;

/// A swept parameter as an axis of a map with one rectangular cell for each point. A cell extends half-way to
/// both neighbouring values; the first and the last cell end at their own values.
struct MapAxis {
  const study::SweepAxis& axis;
  std::vector<double> values;
  bool by_ratio{false};

  explicit MapAxis(const study::SweepAxis& swept)
      : axis(swept), values(values_of(swept)), by_ratio(spaced_by_ratio(values)) {}

  double at(std::int64_t point) const { return axis.numbers[static_cast<std::size_t>(point)]; }
  double between(double a, double b) const { return by_ratio ? std::sqrt(a * b) : 0.5 * (a + b); }
  double from(double value) const {
    const auto found = std::ranges::lower_bound(values, value);
    return found == values.begin() ? value : between(*(found - 1), value);
  }
  double to(double value) const {
    const auto found = std::ranges::lower_bound(values, value);
    return found + 1 == values.end() ? value : between(value, *(found + 1));
  }
  theory::PlaneAxis of_criteria() const { return {axis.name, values.front(), values.back(), by_ratio}; }
};

/// Map of design points that differ only in two swept numbers: one along x, one along y.
struct MapOfPoints {
  const ReportedStudy& reported;
  const PointGroup& group;
  MapAxis x, y;

  CellEdges cell_of(std::int64_t point) const {
    return {x.from(x.at(point)), x.to(x.at(point)), y.from(y.at(point)), y.to(y.at(point))};
  }
};

FigureData cells_of(const MapOfPoints& map) {
  FigureData cells{"cells",
                   {{"label", "point", ""},
                    {"x_from", "", map.x.axis.unit},
                    {"x_to", "", map.x.axis.unit},
                    {"y_from", "", map.y.axis.unit},
                    {"y_to", "", map.y.axis.unit},
                    {"x", map.x.axis.name, map.x.axis.unit},
                    {"y", map.y.axis.name, map.y.axis.unit},
                    {"rate", std::string(name_of_rate(question_of(map.reported))), "1"},
                    {"low", "lower 95 % bound", "1"},
                    {"high", "upper 95 % bound", "1"},
                    {"stable", "(6) holds in", "1"},
                    {"unstable", "(7) exceeded in", "1"},
                    {"star", "", ""}}};
  const std::vector<theory::PointPrediction>& predictions = map.reported.summary.predictions;
  for (const std::int64_t point : map.group.points) {
    const goal::QuestionRate rate = shown_rate(map.reported, point);
    const theory::PointPrediction prediction =
        predictions.empty() ? theory::PointPrediction{} : predictions[static_cast<std::size_t>(point)];
    const std::int64_t of = theory::predicted_trials(prediction);
    const CellEdges cell = map.cell_of(point);
    cells.rows.push_back(
        {marked_label_of(map.reported, point), cell.x_from, cell.x_to, cell.y_from, cell.y_to,
         map.x.at(point), map.y.at(point), datum(rate.value), datum(rate.bounds.low), datum(rate.bounds.high),
         datum(statistics::rate(prediction.stable, of)), datum(statistics::rate(prediction.unstable, of)),
         point == map.reported.chosen.point ? "★" : ""});
  }
  return cells;
}

/// Whether the observed rates at the design point meet every goal in every setting, without regard to bounds.
bool seems_met(const ReportedStudy& reported, std::int64_t point) {
  return std::ranges::all_of(shown_lines(reported), [&](const ShownLine& line) {
    return line.rate(point).value >= line.asked().get<double>();
  });
}

FigureData curves_of(const MapOfPoints& map) {
  const theory::CriterionPlane plane{map.x.of_criteria(), map.y.of_criteria()};
  FigureData data{"curves",
                  {{"criterion", "criterion", ""},
                   {"which", "trial (first or last to reach it)", ""},
                   {"curve", "", ""},
                   {"x", map.x.axis.name, map.x.axis.unit},
                   {"y", map.y.axis.name, map.y.axis.unit},
                   {"order", "", "1"},
                   {"name_here", "", "1"},
                   {"side", "", ""}}};
  double place = 0.85;  // height of the first label; different heights avoid overlaps
  for (const theory::CriterionCurve& curve :
       theory::criterion_curves(map.reported.study, map.group.points.front(), plane)) {
    const char* which = curve.first ? "first" : "last";
    const auto named = static_cast<std::size_t>(place * static_cast<double>(curve.points.size()));
    // The label stands outside of the pair of curves if there is room.
    const bool room =
        curve.points[named].x < map.x.between(plane.x.high, map.x.between(plane.x.low, plane.x.high));
    const char* side = curve.first || !room ? "right" : "left";
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      data.rows.push_back(ordered_json::array(
          {curve.criterion, which, fmt::format("{} {}", curve.criterion, which), datum(curve.points[i].x),
           datum(curve.points[i].y), static_cast<std::int64_t>(i), i == named, side}));
    }
    place -= 0.17;
  }
  return data;
}

/// Boundary around the points at which the observed rate meets the goal. Empty without a goal, or if cells of
/// the map are missing.
FigureData goal_boundary(const MapOfPoints& map) {
  FigureData data = boundaries_data();
  const std::size_t columns = map.x.values.size();
  std::vector<std::int64_t> points = map.group.points;
  if (!question_of(map.reported).goal() || points.size() != columns * map.y.values.size()) return data;
  std::ranges::sort(points, {},
                    [&](std::int64_t point) { return std::pair(map.y.at(point), map.x.at(point)); });
  std::vector<CellEdges> cells;
  std::vector<char> met;
  for (const std::int64_t point : points) {
    cells.push_back(map.cell_of(point));
    met.push_back(seems_met(map.reported, point) ? 1 : 0);
  }
  add_boundary(data, "goal met", cells, columns, [&](std::size_t i) { return met[i] != 0; });
  return data;
}

Figure map_figure(const MapOfPoints& map, std::size_t number) {
  const bool has_goal = question_of(map.reported).goal().has_value();
  FigureData curves = curves_of(map);
  std::string caption = fmt::format(
      "Each cell is a design point. Its colour is the proportion of the {}. A star marks the chosen "
      "point. {}",
      meeting_noun(question_of(map.reported)),
      has_goal ? "The boundary encloses points at which the goal is met, as observed. " : "");
  if (!curves.rows.empty()) {
    caption +=
        "The lines are the paper's criteria (6), white, and (7), orange; solid for the trial with the lowest "
        "bound, dashed for the trial with the highest. Below the solid line of (6) the theory promises "
        "stability of every trial; above the dashed line of (7) it predicts instability of every trial. The "
        "rate should decrease between them.";
  }
  // "Which controller.ki and controller.kp meet the goal? controller.kd 0.1"
  const std::string title = fmt::format(
      "{} {} and {} {}?{}{}", has_goal ? "Which" : "At which", map.x.axis.name, map.y.axis.name,
      has_goal ? "meet the goal" : "do trials succeed", map.group.label.empty() ? "" : " ", map.group.label);
  Figure figure =
      figure_of("stability-map", number == 0 ? "stability-map" : fmt::format("stability-map-{}", number + 1),
                title, caption, {cells_of(map), std::move(curves), goal_boundary(map)});
  for (const auto& [name, one] : {std::pair("x", &map.x), {"y", &map.y}}) {
    figure.parameters[fmt::format("{}_domain", name)] = {one->values.front(), one->values.back()};
    figure.parameters[fmt::format("{}_scale", name)] = one->by_ratio ? "log" : "linear";
  }
  return figure;
}

}  // namespace

std::vector<Figure> stability_maps(const ReportedStudy& reported) {
  std::vector<Figure> maps;
  if (reported.study.open_loop) return maps;
  std::vector<std::size_t> axes = numeric_axes(reported, 2);
  const std::vector<study::SweepAxis>& all = reported.summary.axes;
  if (axes.size() < 2 || values_of(all[axes[0]]).size() < 3) return maps;
  const auto gain = std::find_if(axes.begin(), axes.end(),
                                 [&](std::size_t i) { return all[i].name == parameter::controller::ki; });
  if (gain != axes.end()) std::rotate(axes.begin(), gain, gain + 1);
  const std::vector<PointGroup> groups = groups_along(reported, {axes[0], axes[1]});
  for (const std::int64_t group : statistics::spread_over(std::ssize(groups), max_maps)) {
    const MapOfPoints map{reported, groups[static_cast<std::size_t>(group)], MapAxis(all[axes[0]]),
                          MapAxis(all[axes[1]])};
    maps.push_back(map_figure(map, maps.size()));
  }
  return maps;
}

namespace {

/// A curve of a proportion over the ages of the machines.
struct AgeSeries {
  std::string name;
  std::optional<goal::BoundedProportion> (*of)(const summary::CellOfPoint&);
  std::optional<double> asked;
};

FigureData data_of_ages(const ReportedStudy& reported, const std::vector<summary::CellOfPoint>& ages,
                        const std::vector<AgeSeries>& series) {
  FigureData data{"ages",
                  {{"series", "of", ""},
                   {"age", "age", question_of(reported).settings.ages.unit},
                   {"rate", "proportion", "1"},
                   {"low", "lower bound", "1"},
                   {"high", "upper bound", "1"},
                   {"asked", "asked", "1"}}};
  for (const AgeSeries& one : series) {
    for (const summary::CellOfPoint& age : ages) {
      const std::optional<goal::BoundedProportion> rate = one.of(age);
      if (!rate) continue;
      data.rows.push_back(
          ordered_json::array({one.name, datum(age.age), datum(rate->value), datum(rate->low),
                               datum(rate->high), one.asked ? datum(*one.asked) : ordered_json()}));
    }
  }
  return data;
}

std::string bounds_text(const ReportedStudy& reported) {
  return fmt::format("one-sided bounds with {:.4g} % confidence each",
                     100.0 * goal::confidence_of(question_of(reported), reported.summary.confidence));
}

Figure rates_figure(const ReportedStudy& reported, const std::vector<summary::CellOfPoint>& ages) {
  const goal::Question& question = question_of(reported);
  std::vector<AgeSeries> series{{question.goal() ? "moves in the goal" : "trials that succeed",
                                 [](const summary::CellOfPoint& age) { return std::optional(age.rate); },
                                 std::nullopt}};
  const bool one_claim = question.goal() && !has_several(question);
  if (one_claim) series.front().asked = question.goal()->moves;
  if (question.goal())
    series.push_back({"machines in the goal", [](const summary::CellOfPoint& age) { return age.machines; },
                      one_claim ? question.goal()->machines : std::nullopt});
  Figure figure = figure_of(
      "ages", "ages", "How long does it hold?",
      fmt::format(
          "Proportions at each age, at {}: for moves, those of the worst goal and condition{}; {}. Dashed: "
          "what is asked.",
          label_of(reported, reported.chosen.point),
          question.goal() ? "; of machines those that meet every goal under every condition" : "",
          bounds_text(reported)),
      {data_of_ages(reported, ages, series)});
  scale_ages(figure, question.settings.ages.at);
  return figure;
}

Figure lives_figure(const ReportedStudy& reported, const std::vector<summary::CellOfPoint>& ages) {
  Figure figure = figure_of(
      "ages", "lives", "How long do the machines live?",
      fmt::format(
          "Proportion of the machines that meet every goal under every condition at each age up to one, "
          "at {}; Clopper-Pearson, {}.",
          label_of(reported, reported.chosen.point), bounds_text(reported)),
      {data_of_ages(
          reported, ages,
          {{"machines", [](const summary::CellOfPoint& age) { return age.living; }, std::nullopt}})});
  scale_ages(figure, question_of(reported).settings.ages.at);
  figure.parameters["interpolate"] = "step-after";
  return figure;
}

}  // namespace

std::vector<Figure> age_figures(const ReportedStudy& reported) {
  const std::vector<summary::CellOfPoint> ages =
      summary::ages_of_point(reported.summary, reported.chosen.point);
  std::vector<Figure> figures;
  if (ages.empty()) return figures;
  figures.push_back(rates_figure(reported, ages));
  if (question_of(reported).goal()) figures.push_back(lives_figure(reported, ages));
  return figures;
}

}  // namespace zerocount::report
