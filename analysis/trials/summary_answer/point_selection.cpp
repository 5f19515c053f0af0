#include "analysis/trials/summary_answer/point_selection.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "analysis/trials/summary_answer/parts.hpp"
#include "core/failure/failure.hpp"
#include "core/text/text.hpp"
#include "core/trial/move_measures.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::summary_answer {
namespace {

using summary::StudySummary;

/// Name of the CSV column for the name of a statistic that the user gave: "band_settling_time_p95[1]" for
/// "band_settling_time[1].p95".
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

/// The swept parameter with this full or short name; null if there is none.
const study::SweepAxis* find_axis(const StudySummary& summary, std::string_view name) {
  for (const study::SweepAxis& axis : summary.axes) {
    if (axis.name == name || summary::short_name(summary.axes, axis) == name) return &axis;
  }
  return nullptr;
}

std::string known_names(const StudySummary& summary) {
  std::string names;
  for (const study::SweepAxis& axis : summary.axes) names += axis.name + ", ";
  return names + "label, point, success_rate, arrival_time_p95 and the other columns of --format csv";
}

/// [point] The numbers in a column of the CSV output; empty if the CSV has no such column.
std::optional<std::vector<double>> csv_values(const StudySummary& summary, const std::string& name) {
  const document::Description<DescribedPoint> description = point_description(summary);
  const auto is_column = [&](const auto& cell) { return cell.first == name; };
  for (std::size_t i = 0; i < description.items().size(); ++i) {
    const document::Item& item = description.items()[i];
    if (std::ranges::none_of(document::csv_cells(item, {}), is_column)) continue;
    std::vector<double> values;
    for (std::int64_t point = 0; point < std::ssize(summary.points); ++point) {
      const document::Content content =
          description.content_of(i)(read_point(summary, point), document::Audience::csv);
      const auto cells = document::csv_cells(item, content);
      values.push_back(text::parse_number<double>(std::ranges::find_if(cells, is_column)->second)
                           .value_or(statistics::unknown));
    }
    return values;
  }
  return std::nullopt;
}

using KnownValues = std::map<std::string, std::vector<double>>;

/// [point] The values with this name: a swept parameter, a stored statistic or a column of the CSV.
/// @param known values that the file stores
/// @throws Failure (bad_input) for an unknown name
std::vector<double> values_of(const StudySummary& summary, std::string_view name, const KnownValues& known) {
  const study::SweepAxis* const axis = find_axis(summary, name);
  if (axis != nullptr && axis->kind == study::SweepAxis::Kind::number) return axis->numbers;
  const std::string column = column_name(name);
  if (const auto stored = known.find(column); stored != known.end()) return stored->second;
  if (const auto values = csv_values(summary, column)) return *values;
  if (const std::string_view meanings = trial::meanings_of_settling_time(name); !meanings.empty())
    throw Failure(ExitCode::bad_input,
                  fmt::format("the value '{}' may mean two measures; expected {}", name, meanings));
  throw Failure(ExitCode::bad_input,
                fmt::format("unknown value '{}'; expected {}", name, known_names(summary)));
}

/// [point] The texts with this name: the words of a swept choice, or the labels of the points. Null if the
/// name does not stand for texts.
const std::vector<std::string>* texts_of(const StudySummary& summary, std::string_view name) {
  if (const study::SweepAxis* const axis = find_axis(summary, name))
    return axis->kind == study::SweepAxis::Kind::text ? &axis->texts : nullptr;
  return name == "label" ? &summary.labels : nullptr;
}

/// [point] Rank of the point's text among all texts in alphabetical order.
std::vector<double> ranks_of(const std::vector<std::string>& texts) {
  std::vector<std::string> sorted = texts;
  std::ranges::sort(sorted);
  std::vector<double> ranks;
  ranks.reserve(texts.size());
  for (const std::string& text : texts)
    ranks.push_back(static_cast<double>(std::ranges::lower_bound(sorted, text) - sorted.begin()));
  return ranks;
}

[[noreturn]] void refuse(std::string_view condition) {
  throw Failure(ExitCode::bad_input,
                fmt::format("'{}' is not a condition; expected one such as 'kp > 0', 'case != best' or "
                            "'success_rate >= 0.9'",
                            condition));
}

text::Comparison parts_of_condition(std::string_view condition) {
  const std::optional<text::Comparison> parts = text::parse_comparison(condition);
  if (!parts) refuse(condition);
  return *parts;
}

/// The text without quotation marks around it.
std::string_view unquoted(std::string_view text) {
  const bool quoted =
      text.size() >= 2 && text.front() == text.back() && (text.front() == '"' || text.front() == '\'');
  return quoted ? text.substr(1, text.size() - 2) : text;
}

/// The first few distinct texts, in their order, separated by commas for a message.
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

/// [point] Whether the condition on a text (= or !=) holds.
/// @throws Failure (bad_input) if no point has the text, or for another relation
std::vector<bool> texts_hold(const std::vector<std::string>& texts, const text::Comparison& condition) {
  const std::string_view wanted = unquoted(condition.limit);
  const bool equal = condition.relation == text::Relation::equal;
  const bool of_texts = equal || condition.relation == text::Relation::unequal;
  if (!of_texts || std::ranges::find(texts, wanted) == texts.end()) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("'{} {} {}': {}; expected '{} = NAME' or '{} != NAME' with one of {}",
                              condition.name, condition.written, condition.limit,
                              of_texts ? fmt::format("there is no such {}", condition.name)
                                       : fmt::format("a {} is a name", condition.name),
                              condition.name, condition.name, names_among(texts)));
  }
  std::vector<bool> holds;
  holds.reserve(texts.size());
  for (const std::string& text : texts) holds.push_back((text == wanted) == equal);
  return holds;
}

/// [point] Whether the condition `text`, such as "kp > 0", holds.
/// @param known values that the file stores
std::vector<bool> holds_at(const StudySummary& summary, const std::string& text, const KnownValues& known) {
  const text::Comparison condition = parts_of_condition(text);
  if (const std::vector<std::string>* const texts = texts_of(summary, condition.name))
    return texts_hold(*texts, condition);
  const auto limit = text::parse_number<double>(condition.limit);
  if (!limit) refuse(text);
  const std::vector<double> values =
      text::values_as_written(condition.relation, values_of(summary, condition.name, known), condition.limit);
  std::vector<bool> holds;
  holds.reserve(values.size());
  for (const double value : values) holds.push_back(text::holds(condition.relation, value, *limit));
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

std::vector<std::int64_t> matching_points(const StudySummary& summary, const PointSelection& selection,
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
  return points;
}

std::vector<std::int64_t> first_points(std::vector<std::int64_t> points, const PointSelection& selection) {
  if (selection.top && *selection.top < std::ssize(points))
    points.resize(static_cast<std::size_t>(*selection.top));
  return points;
}

}  // namespace zerocount::summary_answer
