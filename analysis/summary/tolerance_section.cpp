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
  return (point.worlds ? "on average over the worlds: " : "") + statistics::claim_sentence(point.claim) +
         (settling.empty() ? "" : "; " + settling);
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

std::vector<layout::PointColumn> columns_of(std::span<const measures::PointSummary> points,
                                            const study::StudyFeatures& features) {
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
  for (const measures::StatisticField& field : measures::mean_bound_fields(
           features, points.empty() ? layout::measure_table() : *points.front().table))
    columns.push_back(column_of(points, text::flat_name(field), field.unit, field.long_name, field.value));
  return columns;
}

text::TextColumn text_column(std::span<const measures::PointSummary> points, std::string head,
                             const auto& cell) {
  text::TextColumn column{std::move(head), true, {}};
  for (const measures::PointSummary& point : points) {
    if (point.trials > 0) column.cells.push_back(cell(point));
  }
  return column;
}

std::string title_of(std::span<const measures::PointSummary> points) {
  const double confidence = points.empty() ? statistics::summary_confidence : points.front().claim.confidence;
  const bool in_worlds =
      std::ranges::any_of(points, [](const auto& point) { return point.worlds.has_value(); });
  return fmt::format("shown with {} confidence of all axes that the manifest describes{}",
                     text::percent(confidence),
                     in_worlds ? ", on average over its worlds: in some worlds it is less" : "");
}

/// With one trial per rig, nothing is known of the moves of a rig.
bool shows_rigs(std::span<const measures::PointSummary> points) {
  return on_rigs(points) && points.front().trials > points.front().rigs.n;
}

text::PointTable table_of(std::span<const measures::PointSummary> points,
                          const std::vector<std::string>& labels) {
  using Point = const measures::PointSummary&;
  text::PointTable table{{{"point", false, {}}}, {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].trials == 0) continue;  // of an unfinished run
    table.columns[0].cells.push_back(text::printable(labels[i]));
    table.points.push_back(static_cast<std::int64_t>(i));
  }
  table.columns.push_back(text_column(
      points, "success ≥", [](Point point) { return text::percent_at_least(point.claim.success_at_least); }));
  if (shows_rigs(points)) {
    table.columns.push_back(text_column(points, "90 % of rigs ≥", [](Point point) {
      const double zero = point.rigs.tolerance.zero_at_least;
      return std::isnan(zero) ? "–" : text::percent_at_least(zero);
    }));
  }
  for (std::size_t i = 0; i < std::size(statistics::tolerance_contents); ++i) {
    table.columns.push_back(
        text_column(points, fmt::format("{} arrive by (s)", text::percent(statistics::tolerance_contents[i])),
                    [i](Point point) { return text::short_number(point.settles_within.at(i).within); }));
  }
  return table;
}

}  // namespace

measures::SummarySection tolerance_section(std::span<const measures::PointSummary> points,
                                           const std::vector<std::string>& labels,
                                           const study::StudyFeatures& features) {
  measures::SummarySection section{
      .key = "assurance", .json = {}, .columns = columns_of(points, features), .title = title_of(points)};
  section.of_success = true;
  section.tables.push_back(table_of(points, labels));
  section.note = fmt::format(
      "bounds of one side each (Wilks; {}). success: of trials{}; arrive by: all moves of a trial; a "
      "tolerance "
      "limit is later than the quantile of the trials at hand, and – where these are too few, or too many "
      "never arrive\n",
      on_rigs(points) ? "Korn and Graubard" : "Clopper and Pearson",
      shows_rigs(points) ? "; of rigs: their moves that end at zero error" : "");
  for (const measures::PointSummary& point : points) section.json.push_back(point_json(point));
  return section;
}

}  // namespace zerocount::summary
