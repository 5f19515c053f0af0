#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "analysis/summary/point_names.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "analysis/text/text.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::summary_answer {
namespace {

using Point = const PointReading&;

/// More swept parameters than this make the table too wide: the labels alone tell the points apart.
constexpr std::size_t max_swept_columns = 4;

std::string shown_value(const study::SweepAxis& axis, Point p) {
  if (axis.kind == study::SweepAxis::Kind::text) return text::printable(axis.texts[p.index()]);
  const double value = axis.numbers[p.index()];
  if (std::isnan(value)) return "random";
  const auto row = parameters::find_parameter(axis.name);
  if (row && parameters::parameter_table()[*row].none == value) return "none";
  return fmt::format("{:.6g}", value);
}

/// Whether the labels are those of a grid, which name its values: "fast, controller.kp=0.0003".
bool labels_name_values(const summary::StudySummary& summary,
                        const std::vector<const study::SweepAxis*>& swept) {
  return std::ranges::any_of(swept, [&](const study::SweepAxis* axis) {
    return std::ranges::all_of(summary.labels, [axis](const std::string& label) {
      return label.find(axis->name + "=") != std::string::npos;
    });
  });
}

}  // namespace

std::function<std::string(Point)> short_label(const summary::StudySummary& summary) {
  return [labels = std::make_shared<const std::vector<std::string>>(summary::short_labels(
              summary.labels, summary.axes))](Point p) { return text::printable((*labels)[p.index()]); };
}

PointDescription labelled_points(const summary::StudySummary& summary) {
  return PointDescription().value({.heading = "point"}, short_label(summary));
}

void add_axes(PointDescription& point, const summary::StudySummary& summary) {
  std::vector<const study::SweepAxis*> shown = summary::varying_parameters(summary.axes);
  if (shown.size() > max_swept_columns) shown.clear();
  const bool by_number = labels_name_values(summary, shown);
  const auto label = short_label(summary);
  point
      .value({.key = "point",
              .heading = "point",
              .meaning = "number of the design point, for people its label; *: the headline speaks of it"},
             &PointReading::point)
      .shown_as([by_number, label](Point p) {
        return (by_number ? fmt::format("{}", p.point) : label(p)) + (p.marked ? " *" : "");
      })
      .value({.key = "label", .heading = "point", .meaning = "label of the design point", .names_row = true},
             &PointReading::label)
      .shown_as(label)
      .value({.key = "axes",
              .meaning = "values of the swept parameters; null where one has a distribution",
              .shown = document::Shown::in_json},
             [](Point p) {
               std::vector<std::pair<std::string, AxisValue>> values;
               for (const study::SweepAxis& axis : p.summary.axes)
                 values.emplace_back(axis.name, value_at(axis, p));
               return values;
             });
  for (const study::SweepAxis& axis : summary.axes) {
    const bool is_shown = axis.name == "case" ? by_number : std::ranges::find(shown, &axis) != shown.end();
    point
        .value({.key = axis.name,
                .heading = is_shown ? summary::short_name(summary.axes, axis) : "",
                .meaning = axis.meaning,
                .unit = axis.unit,
                .shown = is_shown ? document::Shown::not_in_json : document::Shown::in_csv,
                .numeric = axis.kind == study::SweepAxis::Kind::number},
               [&axis](Point p) { return value_at(axis, p); })
        .shown_as([&axis](Point p) { return shown_value(axis, p); });
  }
}

AxisValue value_at(const study::SweepAxis& axis, Point p) {
  if (axis.kind == study::SweepAxis::Kind::text) return axis.texts[p.index()];
  return axis.numbers[p.index()];
}

}  // namespace zerocount::summary_answer
