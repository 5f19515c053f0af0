#include "analysis/summary/shown_points.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

#include "analysis/measures/point_columns.hpp"
#include "analysis/summary/best_point.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::summary {
namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

/// "band_settling_time_p95[1]" for "band_settling_time[1].p95".
std::string column_name(std::string_view name) {
  std::string column(name);
  const std::size_t open = column.find('[');
  const std::size_t close = column.find(']');
  if (open < close && close != std::string::npos) {
    const std::string band = column.substr(open, close + 1 - open);
    column.erase(open, band.size());
    column += band;
  }
  std::ranges::replace(column, '.', '_');
  return column;
}

template <class Value>
std::vector<double> by_point(const StudySummary& summary, const Value& value) {
  std::vector<double> values;
  for (const measures::PointSummary& point : summary.points) values.push_back(value(point));
  return values;
}

/// The swept parameter of this name, in full or short; null if there is none.
const study::SweepAxis* find_axis(const StudySummary& summary, std::string_view name) {
  for (const study::SweepAxis& axis : summary.axes) {
    if (axis.name == name || short_name(summary.axes, axis) == name) return &axis;
  }
  return nullptr;
}

std::string known_names(const StudySummary& summary) {
  std::string names;
  for (const study::SweepAxis& axis : summary.axes) names += axis.name + ", ";
  return names + "success_rate, settling_time_p95 and the other columns of --format csv";
}

/// [point] the value of this name.
std::vector<double> values_of(const StudySummary& summary, std::string_view name) {
  const study::SweepAxis* const axis = find_axis(summary, name);
  if (axis != nullptr && axis->kind == study::SweepAxis::Kind::number) return axis->numbers;
  const std::string column = column_name(name);
  for (const measures::StatisticField& field : measures::statistic_fields(summary.features, summary.table()))
    if (text::flat_name(field) == column) return by_point(summary, field.value);
  for (const measures::SummarySection& section : summary.sections) {
    for (const layout::PointColumn& values : section.columns)
      if (values.name == column) return values.values;
  }
  if (name == "point") {
    std::vector<double> numbers(summary.points.size());
    std::iota(numbers.begin(), numbers.end(), 0.0);
    return numbers;
  }
  throw Failure(ExitCode::bad_input,
                fmt::format("unknown value '{}'; expected {}", name, known_names(summary)));
}

/// How a condition relates a value to its limit.
struct Relation {
  std::string_view sign;
  bool (*holds)(double, double);
};

constexpr std::array<Relation, 7> relations{{{"<=", [](double a, double b) { return a <= b; }},
                                             {"≤", [](double a, double b) { return a <= b; }},
                                             {">=", [](double a, double b) { return a >= b; }},
                                             {"≥", [](double a, double b) { return a >= b; }},
                                             {"<", [](double a, double b) { return a < b; }},
                                             {">", [](double a, double b) { return a > b; }},
                                             {"=", [](double a, double b) { return a == b; }}}};

[[noreturn]] void refuse(std::string_view condition) {
  throw Failure(ExitCode::bad_input,
                fmt::format("'{}' is not a condition; expected one such as 'kp > 0' or 'success_rate >= 0.9'",
                            condition));
}

/// [point] whether the condition holds.
std::vector<bool> holds_at(const StudySummary& summary, const std::string& condition) {
  for (const Relation& relation : relations) {
    const std::size_t at = condition.find(relation.sign);
    if (at == std::string::npos) continue;
    const std::string_view name = trimmed(std::string_view(condition).substr(0, at));
    const std::string_view limit = trimmed(std::string_view(condition).substr(at + relation.sign.size()));
    std::vector<bool> holds;
    const study::SweepAxis* const axis = find_axis(summary, name);
    if (axis != nullptr && axis->kind == study::SweepAxis::Kind::text && relation.sign == "=") {
      for (const std::string& text : axis->texts) holds.push_back(text == limit);
      return holds;
    }
    double number = 0.0;
    const auto [end, error] = std::from_chars(limit.data(), limit.data() + limit.size(), number);
    if (error != std::errc{} || end != limit.data() + limit.size()) refuse(condition);
    for (const double value : values_of(summary, name)) holds.push_back(relation.holds(value, number));
    return holds;
  }
  refuse(condition);
}

void sort_by(std::vector<std::int64_t>& points, const std::vector<double>& values, bool decreasing) {
  std::ranges::stable_sort(points, [&](std::int64_t a, std::int64_t b) {
    const double of_a = values[static_cast<std::size_t>(a)];
    const double of_b = values[static_cast<std::size_t>(b)];
    if (std::isnan(of_a) || std::isnan(of_b)) return !std::isnan(of_a) && std::isnan(of_b);
    return decreasing ? of_a > of_b : of_a < of_b;
  });
}

}  // namespace

std::vector<std::string> short_labels(std::vector<std::string> labels,
                                      std::span<const study::SweepAxis> axes) {
  for (const study::SweepAxis& axis : axes) {
    const std::string name = short_name(axes, axis);
    for (std::string& label : labels) {
      replace_all(label, ", " + axis.name + "=", " " + name + "=");
      if (label.starts_with(axis.name + "=")) label.replace(0, axis.name.size(), name);
    }
  }
  return labels;
}

std::vector<std::string> point_names(const StudySummary& summary) {
  std::vector<std::string> names = short_labels(summary.labels, summary.axes);
  for (std::size_t i = 0; i < names.size(); ++i)
    names[i] = names[i] == summary.labels[i] ? text::printable(names[i])
                                             : fmt::format("{} ({})", i, text::printable(names[i]));
  return names;
}

std::vector<std::int64_t> selected_points(const StudySummary& summary, const PointSelection& selection) {
  std::vector<std::int64_t> points(summary.points.size());
  std::iota(points.begin(), points.end(), std::int64_t{0});
  const bool by_merit = selection.sort == "best" || (selection.top && !selection.sort);
  if (by_merit) points = points_by_merit(summary);
  if (selection.sort && !by_merit) {
    const bool decreasing = selection.sort->starts_with('-');
    sort_by(points, values_of(summary, std::string_view(*selection.sort).substr(decreasing ? 1 : 0)),
            decreasing);
  }
  for (const std::string& condition : selection.where) {
    const std::vector<bool> holds = holds_at(summary, condition);
    std::erase_if(points, [&](std::int64_t point) { return !holds[static_cast<std::size_t>(point)]; });
  }
  if (points.empty()) throw Failure(ExitCode::inconclusive, "no design point meets the conditions");
  if (selection.top && *selection.top < std::ssize(points))
    points.resize(static_cast<std::size_t>(*selection.top));
  return points;
}

}  // namespace zerocount::summary
