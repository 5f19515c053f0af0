#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/report/figures/report_figures.hpp"
#include "analysis/report/reported_study.hpp"
#include "analysis/statistics/spread_over.hpp"
#include "analysis/theory/curves.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t max_maps = 4;

/// The cells of the values of an axis: each extends half-way to both neighbours. The first and last cell end
/// at their values.
struct AxisCells {
  std::vector<double> values;
  bool by_ratio{false};

  explicit AxisCells(const study::SweepAxis& axis)
      : values(values_of(axis)), by_ratio(spaced_by_ratio(values)) {}

  double between(double a, double b) const { return by_ratio ? std::sqrt(a * b) : 0.5 * (a + b); }
  double from(double value) const {
    const auto at = std::lower_bound(values.begin(), values.end(), value);
    return at == values.begin() ? value : between(*(at - 1), value);
  }
  double to(double value) const {
    const auto at = std::lower_bound(values.begin(), values.end(), value);
    return at + 1 == values.end() ? value : between(value, *(at + 1));
  }
};

void set_axis(ordered_json& channel, const study::SweepAxis& axis, const AxisCells& edges) {
  channel["title"] = axis_title(axis);
  channel["scale"]["domain"] = {edges.values.front(), edges.values.back()};
  if (edges.by_ratio) channel["scale"]["type"] = "log";
}

FigureData cells_of(const ReportedStudy& reported, const PointGroup& group, const study::SweepAxis& x,
                    const study::SweepAxis& y) {
  const AxisCells x_edges(x);
  const AxisCells y_edges(y);
  FigureData cells{"cells",
                   {{"label", "point", ""},
                    {"x_from", "", x.unit},
                    {"x_to", "", x.unit},
                    {"y_from", "", y.unit},
                    {"y_to", "", y.unit},
                    {"x", x.name, x.unit},
                    {"y", y.name, y.unit},
                    {"rate", std::string(words_of(question_of(reported)).rate), "1"},
                    {"low", "lower 95 % bound", "1"},
                    {"high", "upper 95 % bound", "1"},
                    {"stable", "(6) holds in", "1"},
                    {"unstable", "(7) exceeded in", "1"},
                    {"star", "", ""}}};
  for (const std::int64_t point : group.points) {
    const auto at = static_cast<std::size_t>(point);
    const goal::QuestionRate rate = shown_rate(reported, point);
    const bool predicted = !reported.summary.predictions.empty();
    const theory::PointPrediction prediction =
        predicted ? reported.summary.predictions[at] : theory::PointPrediction{};
    const std::int64_t of = theory::predicted_trials(prediction);
    const double x_value = x.numbers[at];
    const double y_value = y.numbers[at];
    cells.rows.push_back(ordered_json::array(
        {marked_label_of(reported, point), x_edges.from(x_value), x_edges.to(x_value), y_edges.from(y_value),
         y_edges.to(y_value), x_value, y_value, datum(rate.value), datum(rate.bounds.low),
         datum(rate.bounds.high), datum(zerocount::statistics::rate(prediction.stable, of)),
         datum(zerocount::statistics::rate(prediction.unstable, of)),
         point == reported.chosen.point ? "★" : ""}));
  }
  return cells;
}

/// Whether what is observed is what every goal asks for, under every condition.
bool seems_met(const ReportedStudy& reported, std::int64_t point) {
  return std::ranges::all_of(parts_of(reported), [&](const ReportedPart& one) {
    return std::ranges::all_of(question_of(one.study).parts, [&](const goal::JudgedPart& part) {
      const goal::Verdict verdict =
          verdict_on(only(question_of(one.study), part.number), point_of(one.study, point));
      return part.claim->machines ? verdict.machines.value >= *part.claim->machines
                                  : verdict.moves.value >= part.claim->moves;
    });
  });
}

FigureData curves_of(const ReportedStudy& reported, const PointGroup& group, const study::SweepAxis& x,
                     const study::SweepAxis& y) {
  const AxisCells x_edges(x);
  const AxisCells y_edges(y);
  const theory::CriterionPlane plane{
      {x.name, x_edges.values.front(), x_edges.values.back(), x_edges.by_ratio},
      {y.name, y_edges.values.front(), y_edges.values.back(), y_edges.by_ratio}};
  FigureData data{"curves",
                  {{"criterion", "criterion", ""},
                   {"which", "trial (first or last to reach it)", ""},
                   {"curve", "", ""},
                   {"x", x.name, x.unit},
                   {"y", y.name, y.unit},
                   {"order", "", "1"},
                   {"name_here", "", "1"},
                   {"side", "", ""}}};
  double place = 0.85;  // height of the first label; different heights avoid overlaps
  for (const theory::CriterionCurve& curve :
       theory::criterion_curves(reported.study, group.points.front(), plane)) {
    const char* which = curve.first ? "first" : "last";
    const auto named = static_cast<std::size_t>(place * static_cast<double>(curve.points.size()));
    // The label stands outside of the pair of curves if there is room.
    const bool room =
        curve.points[named].x < x_edges.between(plane.x.high, x_edges.between(plane.x.low, plane.x.high));
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

/// "Which controller.ki and controller.kp meet the goal? controller.kd 0.1".
std::string map_title(const ReportedStudy& reported, const PointGroup& group, const study::SweepAxis& x,
                      const study::SweepAxis& y) {
  return fmt::format("{} {} and {} {}?{}{}", question_of(reported).claim() ? "Which" : "At which", x.name,
                     y.name, question_of(reported).claim() ? "meet the goal" : "do trials succeed",
                     group.label.empty() ? "" : " ", group.label);
}

/// Where the goal is met by the rate of the trials; nothing without one, or where cells are missing.
FigureData goal_boundary(const ReportedStudy& reported, const PointGroup& group, const study::SweepAxis& x,
                         const study::SweepAxis& y) {
  FigureData data = boundaries_data();
  const AxisCells columns(x);
  const AxisCells rows(y);
  if (!question_of(reported).claim() || group.points.size() != columns.values.size() * rows.values.size())
    return data;
  std::vector<std::int64_t> points = group.points;
  const auto place = [&](std::int64_t point) {
    const auto at = static_cast<std::size_t>(point);
    return std::pair(y.numbers[at], x.numbers[at]);
  };
  std::ranges::sort(points, {}, place);
  std::vector<CellEdges> cells;
  std::vector<char> met;
  for (const std::int64_t point : points) {
    const auto [row, column] = place(point);
    cells.push_back({columns.from(column), columns.to(column), rows.from(row), rows.to(row)});
    met.push_back(seems_met(reported, point) ? 1 : 0);
  }
  add_boundary(data, "goal met", cells, columns.values.size(), [&](std::size_t i) { return met[i] != 0; });
  return data;
}

Figure map_of(const ReportedStudy& reported, const PointGroup& group, std::size_t number,
              const study::SweepAxis& x, const study::SweepAxis& y) {
  FigureData curves = curves_of(reported, group, x, y);
  FigureData boundary = goal_boundary(reported, group, x, y);
  const goal::QuestionWords& words = words_of(question_of(reported));
  std::string caption = fmt::format(
      "Each cell is a design point. Its colour is the proportion of the {}. A star marks the chosen "
      "point. {}",
      words.meeting,
      question_of(reported).claim() ? "The boundary encloses points at which the goal is met, as observed. "
                                    : "");
  if (!curves.rows.empty()) {
    caption +=
        "The lines are the paper's criteria (6), white, and (7), orange; solid for the trial with the lowest "
        "bound, dashed for the trial with the highest. Below the solid line of (6) the theory promises "
        "stability of every trial; above the dashed line of (7) it predicts instability of every trial. The "
        "rate should decrease between them.";
  }
  Figure figure =
      figure_of("stability-map", number == 0 ? "stability-map" : fmt::format("stability-map-{}", number + 1),
                map_title(reported, group, x, y), caption,
                {cells_of(reported, group, x, y), std::move(curves), std::move(boundary)});
  retitle(figure, {{"success rate", words.rate}});
  ordered_json& encoding = figure.specification["layer"][0]["encoding"];
  set_axis(encoding["x"], x, AxisCells(x));
  set_axis(encoding["y"], y, AxisCells(y));
  // A layer without rows would only add to the legend.
  ordered_json& layers = figure.specification["layer"];
  for (auto layer = layers.begin(); layer != layers.end();) {
    const auto data =
        std::ranges::find(figure.data, (*layer)["data"]["name"].get<std::string>(), &FigureData::name);
    layer = data->rows.empty() ? layers.erase(layer) : layer + 1;
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
  const auto gain =
      std::find_if(axes.begin(), axes.end(), [&](std::size_t i) { return all[i].name == "controller.ki"; });
  if (gain != axes.end()) std::rotate(axes.begin(), gain, gain + 1);
  const std::vector<PointGroup> groups = groups_along(reported, {axes[0], axes[1]});
  for (const std::int64_t group : statistics::spread_over(std::ssize(groups), max_maps)) {
    maps.push_back(
        map_of(reported, groups[static_cast<std::size_t>(group)], maps.size(), all[axes[0]], all[axes[1]]));
  }
  return maps;
}

}  // namespace zerocount::report
