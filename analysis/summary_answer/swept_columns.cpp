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

using document::Shown;
using Point = const PointReading&;

/// More swept parameters than this make the table too wide: the labels alone tell the points apart.
constexpr std::size_t max_swept_columns = 4;

std::string number_cell(const study::SweepAxis& axis, double value) {
  if (std::isnan(value)) return "random";
  const auto row = parameters::find_parameter(axis.name);
  if (row && parameters::parameter_table()[*row].none == value) return "none";
  return fmt::format("{:.6g}", value);
}

void add_swept_column(PointDescription& point, const summary::StudySummary& summary, std::size_t axis) {
  const study::SweepAxis& swept = summary.axes[axis];
  const bool numeric = swept.kind == study::SweepAxis::Kind::number;
  point.value({.heading = summary::short_name(summary.axes, swept),
               .unit = numeric ? swept.unit : "",
               .shown = Shown::to_people,
               .numeric = numeric},
              [axis, numeric](Point p) {
                const study::SweepAxis& of = p.summary.axes[axis];
                return numeric ? number_cell(of, of.numbers[p.index()]) : of.texts[p.index()];
              });
}

/// Whether the labels are those of a grid, which name its values: "fast, controller.kp=0.0003".
bool labels_name_values(const summary::StudySummary& summary,
                        const std::vector<const study::SweepAxis*>& swept) {
  return std::any_of(swept.begin(), swept.end(), [&](const study::SweepAxis* axis) {
    return std::all_of(summary.labels.begin(), summary.labels.end(), [axis](const std::string& label) {
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

void add_swept_columns(PointDescription& point, const summary::StudySummary& summary) {
  std::vector<const study::SweepAxis*> swept = summary::varying_parameters(summary.axes);
  if (swept.size() > max_swept_columns) swept.clear();
  const bool by_number = labels_name_values(summary, swept);
  point.value(
      {.heading = "point",
       .meaning = summary.points.size() > 1 ? "*: the chosen point, of which the headline speaks" : "",
       .shown = Shown::to_people},
      [by_number, label = short_label(summary)](Point p) {
        return (by_number ? fmt::format("{}", p.point) : label(p)) + (p.marked ? " *" : "");
      });
  const auto cases = std::ranges::find(summary.axes, "case", &study::SweepAxis::name);
  if (by_number && cases != summary.axes.end())
    point.value({.heading = "case", .shown = Shown::to_people},
                [axis = static_cast<std::size_t>(cases - summary.axes.begin())](Point p) {
                  return text::printable(p.summary.axes[axis].texts[p.index()]);
                });
  for (const study::SweepAxis* axis : swept)
    add_swept_column(point, summary, static_cast<std::size_t>(axis - summary.axes.data()));
}

}  // namespace zerocount::summary_answer
