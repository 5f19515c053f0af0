#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/measures/point_columns.hpp"
#include "analysis/statistics/tolerance.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::summary {
namespace {

using Json = nlohmann::ordered_json;

std::string statement(const measures::PointSummary& point) {
  const std::string settling = statistics::settling_sentence(point.settles_within);
  return statistics::claim_sentence(point.claim) + (settling.empty() ? "" : "; " + settling);
}

Json point_json(const measures::PointSummary& point) {
  Json limits = Json::array();
  for (const statistics::ToleranceLimit& limit : point.settles_within)
    limits.push_back({{"content", limit.content}, {"within", limit.within}});
  Json json{{"success_at_least", point.claim.success_at_least},
            {"failure_at_most", point.claim.failure_at_most},
            {"rule_of_three", statistics::rule_of_three(point.claim)},
            {"settling_time", std::move(limits)},
            {"statement", statement(point)}};
  if (point.rigs.tolerance.min_rigs > 0) {
    json["rigs"] = {{"content", point.rigs.tolerance.content},
                    {"zero_at_least", point.rigs.tolerance.zero_at_least},
                    {"statement", statistics::tolerance_sentence(point.rigs.tolerance)}};
  }
  return json;
}

/// "95", "99", "99_9".
std::string content_name(double content) {
  std::string name = fmt::format("{:.6g}", 100.0 * content);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

template <typename Value>
layout::PointColumn column_of(std::span<const measures::PointSummary> points, std::string name,
                              std::string unit, std::string long_name, const Value& value) {
  layout::PointColumn column{std::move(name), std::move(unit), std::move(long_name), {}};
  for (const measures::PointSummary& point : points) column.values.push_back(value(point));
  return column;
}

bool on_rigs(std::span<const measures::PointSummary> points) {
  return std::ranges::any_of(points,
                             [](const measures::PointSummary& point) { return point.claim.rigs > 0; });
}

std::vector<layout::PointColumn> columns_of(std::span<const measures::PointSummary> points) {
  std::vector<layout::PointColumn> columns{
      column_of(points, "success_at_least", "1",
                "proportion of axes (with rigs: of trials) that succeed at least",
                [](const measures::PointSummary& point) { return point.claim.success_at_least; }),
      column_of(points, "failure_at_most", "1", "proportion of axes (with rigs: of trials) that fail at most",
                [](const measures::PointSummary& point) { return point.claim.failure_at_most; })};
  for (std::size_t i = 0; i < std::size(statistics::tolerance_contents); ++i) {
    const double content = statistics::tolerance_contents[i];
    columns.push_back(
        column_of(points, "settling_within_" + content_name(content), "s",
                  fmt::format("time in which at least {} of axes settle", text::percent(content)),
                  [i](const measures::PointSummary& point) { return point.settles_within.at(i).within; }));
  }
  if (on_rigs(points)) {
    columns.push_back(
        column_of(points, "rigs_zero_at_least", "1",
                  "proportion of moves in which at least 90 % of rigs hold zero at least",
                  [](const measures::PointSummary& point) { return point.rigs.tolerance.zero_at_least; }));
  }
  for (const measures::StatisticField& field :
       measures::mean_bound_fields(points.empty() ? layout::measure_table() : *points.front().table))
    columns.push_back(column_of(points, text::flat_name(field), field.unit, field.long_name, field.value));
  return columns;
}

std::string text_of(std::span<const measures::PointSummary> points, const std::vector<std::string>& labels) {
  std::vector<std::vector<std::string>> cells{
      {"point", "what the trials show of all axes that the manifest describes"}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].trials == 0) continue;  // of an unfinished run
    cells.push_back({text::printable(labels[i]), statement(points[i])});
    if (points[i].rigs.tolerance.min_rigs > 0) {
      cells.back()[1] = statistics::tolerance_sentence(points[i].rigs.tolerance);
      cells.push_back({"", statement(points[i])});
    }
  }
  return text::aligned_table(cells, {false, false}) +
         fmt::format("\nbounds of one side each (Wilks; {}); settle: of the slowest move of a trial\n",
                     on_rigs(points) ? "Korn and Graubard" : "Clopper and Pearson");
}

}  // namespace

measures::SummarySection tolerance_section(std::span<const measures::PointSummary> points,
                                           const std::vector<std::string>& labels) {
  measures::SummarySection section{
      .key = "assurance", .json = {}, .columns = columns_of(points), .text = text_of(points, labels)};
  for (const measures::PointSummary& point : points) section.json.push_back(point_json(point));
  return section;
}

}  // namespace zerocount::summary
