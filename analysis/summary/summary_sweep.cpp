#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "analysis/summary/shown_points.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::summary {
namespace {

/// More swept parameters than this make the table too wide: the labels alone tell the points apart.
constexpr std::size_t max_swept_columns = 4;

bool is_case(const study::SweepAxis& axis) {
  return axis.name == "case";
}

/// Whether any two points have different values, or one of them a distribution.
bool varies(const study::SweepAxis& axis) {
  const auto differs = [](const auto& values) {
    return std::any_of(values.begin(), values.end(), [&](const auto& v) { return !(v == values.front()); });
  };
  return axis.kind == study::SweepAxis::Kind::text ? differs(axis.texts) : differs(axis.numbers);
}

std::vector<const study::SweepAxis*> varying_parameters(std::span<const study::SweepAxis> axes) {
  std::vector<const study::SweepAxis*> found;
  for (const study::SweepAxis& axis : axes) {
    if (!is_case(axis) && varies(axis)) found.push_back(&axis);
  }
  return found;
}

std::string last_parts(const std::string& path, std::size_t parts) {
  std::size_t start = path.size();
  for (; parts > 0 && start != std::string::npos && start > 0; --parts) start = path.rfind('.', start - 1);
  return start == std::string::npos ? path : path.substr(start + 1);
}

std::string number_cell(const study::SweepAxis& axis, double value) {
  if (std::isnan(value)) return "random";
  const auto row = parameters::find_parameter(axis.name);
  if (row && parameters::parameter_table()[*row].none == value) return "none";
  return fmt::format("{:.6g}", value);
}

text::TextColumn swept_column(const StudySummary& summary, const study::SweepAxis& axis) {
  const bool numeric = axis.kind == study::SweepAxis::Kind::number;
  const std::string unit = numeric && axis.unit != "1" ? fmt::format(" ({})", axis.unit) : "";
  text::TextColumn column{short_name(summary.axes, axis) + unit, numeric, {}};
  for (const std::int64_t point : complete_points(summary)) {
    const auto i = static_cast<std::size_t>(point);
    column.cells.push_back(numeric ? number_cell(axis, axis.numbers[i]) : axis.texts[i]);
  }
  return column;
}

/// Whether the labels are those of a grid, which name its values: "fast, controller.kp=0.0003".
bool labels_name_values(const StudySummary& summary, const std::vector<const study::SweepAxis*>& swept) {
  return std::any_of(swept.begin(), swept.end(), [&](const study::SweepAxis* axis) {
    return std::all_of(summary.labels.begin(), summary.labels.end(), [axis](const std::string& label) {
      return label.find(axis->name + "=") != std::string::npos;
    });
  });
}

/// "point": the label, unless other columns say the same; then the number of the point. A star marks the
/// chosen point among several.
text::TextColumn point_column(const StudySummary& summary, bool by_number, std::int64_t chosen) {
  text::TextColumn column{"point", false, {}};
  const std::vector<std::int64_t> points = complete_points(summary);
  std::vector<std::string> labels;
  labels.reserve(points.size());
  for (const std::int64_t point : points) labels.push_back(summary.labels[static_cast<std::size_t>(point)]);
  labels = short_labels(std::move(labels), summary.axes);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const bool marked = summary.points.size() > 1 && points[i] == chosen;
    column.cells.push_back((by_number ? fmt::format("{}", points[i]) : text::printable(labels[i])) +
                           (marked ? " *" : ""));
  }
  return column;
}

}  // namespace

std::string short_name(std::span<const study::SweepAxis> axes, const study::SweepAxis& axis) {
  const std::vector<const study::SweepAxis*> swept = varying_parameters(axes);
  const auto sections = std::count(axis.name.begin(), axis.name.end(), '.');
  for (std::size_t parts = 1; parts <= static_cast<std::size_t>(sections); ++parts) {
    std::string name = last_parts(axis.name, parts);
    const bool is_index = name.find_first_not_of("0123456789.") == std::string::npos;
    const bool unique = std::none_of(swept.begin(), swept.end(), [&](const study::SweepAxis* other) {
      return other->name != axis.name && last_parts(other->name, parts) == name;
    });
    if (unique && !is_index) return name;
  }
  return axis.name;
}

std::vector<text::TextColumn> sweep_columns(const StudySummary& summary, std::int64_t chosen) {
  const std::vector<const study::SweepAxis*> swept = varying_parameters(summary.axes);
  if (swept.empty() || swept.size() > max_swept_columns) return {point_column(summary, false, chosen)};
  const bool by_number = labels_name_values(summary, swept);
  std::vector<text::TextColumn> columns{point_column(summary, by_number, chosen)};
  const auto cases = std::find_if(summary.axes.begin(), summary.axes.end(), is_case);
  if (by_number && cases != summary.axes.end()) {
    text::TextColumn names{"case", false, {}};
    for (const std::int64_t point : complete_points(summary))
      names.cells.push_back(text::printable(cases->texts[static_cast<std::size_t>(point)]));
    columns.push_back(std::move(names));
  }
  for (const study::SweepAxis* axis : swept) columns.push_back(swept_column(summary, *axis));
  return columns;
}

}  // namespace zerocount::summary
