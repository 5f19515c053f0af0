#include "analysis/summary_answer/point_selection.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/document/answer.hpp"
#include "analysis/summary/chosen_point.hpp"
#include "analysis/summary/point_names.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::summary_answer {
namespace {

using summary::StudySummary;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

/// NaN where the text is not a number.
double number_in(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() ? number : statistics::unknown;
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

/// The swept parameter of this name, in full or short; null if there is none.
const study::SweepAxis* find_axis(const StudySummary& summary, std::string_view name) {
  for (const study::SweepAxis& axis : summary.axes) {
    if (axis.name == name || summary::short_name(summary.axes, axis) == name) return &axis;
  }
  return nullptr;
}

std::string known_names(const StudySummary& summary) {
  std::string names;
  for (const study::SweepAxis& axis : summary.axes) names += axis.name + ", ";
  return names + "label, point, success_rate, settling_time_p95 and the other columns of --format csv";
}

/// [point] the numbers in the column of the CSV; nothing where it has no such column.
std::optional<std::vector<double>> csv_values(const StudySummary& summary, const std::string& name) {
  const document::Description<PointReading> description = point_description(summary);
  const auto is_column = [&](const auto& cell) { return cell.first == name; };
  for (std::size_t i = 0; i < description.items().size(); ++i) {
    const document::Item& item = description.items()[i];
    if (std::ranges::none_of(document::csv_cells(item, {}), is_column)) continue;
    std::vector<double> values;
    for (std::int64_t point = 0; point < std::ssize(summary.points); ++point) {
      const document::Content content =
          description.content_of(i)(read_point(summary, point), document::Audience::csv);
      const auto cells = document::csv_cells(item, content);
      values.push_back(number_in(std::ranges::find_if(cells, is_column)->second));
    }
    return values;
  }
  return std::nullopt;
}

using KnownValues = std::map<std::string, std::vector<double>>;

/// [point] the value of this name.
std::vector<double> values_of(const StudySummary& summary, std::string_view name, const KnownValues& known) {
  const study::SweepAxis* const axis = find_axis(summary, name);
  if (axis != nullptr && axis->kind == study::SweepAxis::Kind::number) return axis->numbers;
  const std::string column = column_name(name);
  if (const auto stored = known.find(column); stored != known.end()) return stored->second;
  if (const auto values = csv_values(summary, column)) return *values;
  throw Failure(ExitCode::bad_input,
                fmt::format("unknown value '{}'; expected {}", name, known_names(summary)));
}

/// [point] the text of this name: a swept choice of names, or the labels; null where the name is not of
/// texts.
const std::vector<std::string>* texts_of(const StudySummary& summary, std::string_view name) {
  if (const study::SweepAxis* const axis = find_axis(summary, name))
    return axis->kind == study::SweepAxis::Kind::text ? &axis->texts : nullptr;
  return name == "label" ? &summary.labels : nullptr;
}

/// [point] the place of each text among all in alphabetical order.
std::vector<double> ranks_of(const std::vector<std::string>& texts) {
  std::vector<std::string> sorted = texts;
  std::ranges::sort(sorted);
  std::vector<double> ranks;
  ranks.reserve(texts.size());
  for (const std::string& text : texts)
    ranks.push_back(static_cast<double>(std::ranges::lower_bound(sorted, text) - sorted.begin()));
  return ranks;
}

/// How a condition relates a value to its limit.
struct Relation {
  std::string_view sign;
  bool (*holds)(double, double);
  bool of_texts{false};  ///< texts can be related so, too
};

constexpr std::array<Relation, 10> relations{{{"<=", [](double a, double b) { return a <= b; }},
                                              {"≤", [](double a, double b) { return a <= b; }},
                                              {">=", [](double a, double b) { return a >= b; }},
                                              {"≥", [](double a, double b) { return a >= b; }},
                                              {"!=", [](double a, double b) { return a < b || a > b; }, true},
                                              {"≠", [](double a, double b) { return a < b || a > b; }, true},
                                              {"==", [](double a, double b) { return a == b; }, true},
                                              {"<", [](double a, double b) { return a < b; }},
                                              {">", [](double a, double b) { return a > b; }},
                                              {"=", [](double a, double b) { return a == b; }, true}}};

[[noreturn]] void refuse(std::string_view condition) {
  throw Failure(ExitCode::bad_input,
                fmt::format("'{}' is not a condition; expected one such as 'kp > 0', 'case != best' or "
                            "'success_rate >= 0.9'",
                            condition));
}

/// "kp > 0" in its parts.
struct Condition {
  std::string_view name;
  Relation relation;
  std::string_view limit;
};

/// By the first sign of a relation, so that a text may hold others.
Condition parts_of_condition(std::string_view condition) {
  for (std::size_t at = 0; at < condition.size(); ++at) {
    const auto relation = std::ranges::find_if(
        relations, [&](const Relation& one) { return condition.substr(at).starts_with(one.sign); });
    if (relation == relations.end()) continue;
    return {trimmed(condition.substr(0, at)), *relation,
            trimmed(condition.substr(at + relation->sign.size()))};
  }
  refuse(condition);
}

/// Without the quotation marks around it.
std::string_view unquoted(std::string_view text) {
  const bool quoted =
      text.size() >= 2 && text.front() == text.back() && (text.front() == '"' || text.front() == '\'');
  return quoted ? text.substr(1, text.size() - 2) : text;
}

/// Some of the different texts, in their order.
std::string names_among(const std::vector<std::string>& texts) {
  constexpr std::size_t shown = 8;
  std::vector<std::string> names;
  for (const std::string& text : texts) {
    if (std::ranges::find(names, text) == names.end()) names.push_back(text);
    if (names.size() > shown) break;
  }
  const bool more = names.size() > shown;
  if (more) names.pop_back();
  return fmt::format("{}{}", fmt::join(names, ", "), more ? ", …" : "");
}

/// [point] whether the text is that of the condition, or is not.
std::vector<bool> texts_hold(const std::vector<std::string>& texts, const Condition& condition) {
  const std::string_view wanted = unquoted(condition.limit);
  if (!condition.relation.of_texts || std::ranges::find(texts, wanted) == texts.end()) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("'{} {} {}': {}; expected '{} = NAME' or '{} != NAME' with one of {}",
                              condition.name, condition.relation.sign, condition.limit,
                              condition.relation.of_texts ? fmt::format("there is no such {}", condition.name)
                                                          : fmt::format("a {} is a name", condition.name),
                              condition.name, condition.name, names_among(texts)));
  }
  const bool equal = condition.relation.holds(0.0, 0.0);
  std::vector<bool> holds;
  holds.reserve(texts.size());
  for (const std::string& text : texts) holds.push_back((text == wanted) == equal);
  return holds;
}

/// [point] whether the condition holds.
std::vector<bool> holds_at(const StudySummary& summary, const std::string& text, const KnownValues& known) {
  const Condition condition = parts_of_condition(text);
  if (const std::vector<std::string>* const texts = texts_of(summary, condition.name))
    return texts_hold(*texts, condition);
  double number = 0.0;
  const std::string_view limit = condition.limit;
  const std::vector<double> values = values_of(summary, condition.name, known);
  const auto [end, error] = std::from_chars(limit.data(), limit.data() + limit.size(), number);
  if (error != std::errc{} || end != limit.data() + limit.size()) refuse(text);
  std::vector<bool> holds;
  holds.reserve(values.size());
  for (const double value : values) holds.push_back(condition.relation.holds(value, number));
  return holds;
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

std::vector<std::string> columns_needed(const StudySummary& summary, const PointSelection& selection) {
  std::vector<std::string> columns;
  const auto need = [&](std::string_view name) {
    if (find_axis(summary, name) == nullptr && name != "label" && name != "point")
      columns.push_back(column_name(name));
  };
  if (selection.sort && *selection.sort != "best")
    need(std::string_view(*selection.sort).substr(selection.sort->starts_with('-') ? 1 : 0));
  for (const std::string& condition : selection.where) need(parts_of_condition(condition).name);
  return columns;
}

bool needs_mean_bounds(const PointSelection& selection) {
  std::string names = selection.sort.value_or("");
  for (const std::string& condition : selection.where) names += " " + condition;
  names = column_name(names);
  return names.find("_mean_low") != std::string::npos || names.find("_mean_high") != std::string::npos;
}

void require_columns(const StudySummary& summary, const PointSelection& selection) {
  for (const std::string& column : columns_needed(summary, selection)) values_of(summary, column, {});
}

std::vector<std::int64_t> selected_points(const StudySummary& summary, const PointSelection& selection,
                                          const std::map<std::string, std::vector<double>>& known) {
  std::vector<std::int64_t> points(summary.points.size());
  std::iota(points.begin(), points.end(), std::int64_t{0});
  const bool by_merit = selection.sort == "best" || (selection.top && !selection.sort);
  if (by_merit) points = summary::points_by_merit(summary);
  if (selection.sort && !by_merit) {
    const bool decreasing = selection.sort->starts_with('-');
    const std::string_view name = std::string_view(*selection.sort).substr(decreasing ? 1 : 0);
    const std::vector<std::string>* const texts = texts_of(summary, name);
    sort_by(points, texts != nullptr ? ranks_of(*texts) : values_of(summary, name, known), decreasing);
  }
  for (const std::string& condition : selection.where) {
    const std::vector<bool> holds = holds_at(summary, condition, known);
    std::erase_if(points, [&](std::int64_t point) { return !holds[static_cast<std::size_t>(point)]; });
  }
  if (points.empty()) throw Failure(ExitCode::inconclusive, "no design point meets the conditions");
  if (selection.top && *selection.top < std::ssize(points))
    points.resize(static_cast<std::size_t>(*selection.top));
  return points;
}

}  // namespace zerocount::summary_answer
