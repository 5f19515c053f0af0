#include "analysis/iso230/repeatability_summary.hpp"

#include <cstddef>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "analysis/iso230/repeatability_fields.hpp"
#include "analysis/text/report_json.hpp"

namespace zerocount::iso230 {
namespace {

using Json = nlohmann::ordered_json;

template <typename Values>
void add_values(Json& json, std::span<const RepeatabilityField<Values>> fields,
                std::span<const ValueStatistics> values, bool of_targets) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    Json& value = json[std::string(fields[i].name)];
    for (const ValueStatisticField& statistic : value_statistic_fields()) {
      if (!of_targets || statistic.of_targets) {
        value[std::string(statistic.name)] = statistic.value(values[i]);  // NaN is written as null
      }
    }
  }
}

Json source_json(const PointRepeatability& point, std::size_t source, parameters::AxisKind axis_kind) {
  const SourceRepeatability& values = point.sources[source];
  Json axis;
  add_values(axis, axis_fields(), values.axis, false);
  Json targets = Json::array();
  for (std::size_t i = 0; i < values.targets.size(); ++i) {
    Json target{
        {"target", i}, {"position_min", point.positions[i].min}, {"position_max", point.positions[i].max}};
    add_values(target, target_fields(), values.targets[i], true);
    targets.push_back(std::move(target));
  }
  return {{"unit", parameters::unit_on(axis_kind, deviation_sources()[source].unit)},
          {"axis", std::move(axis)},
          {"targets", std::move(targets)}};
}

Json point_json(const PointRepeatability& point, parameters::AxisKind axis) {
  Json json;
  text::add_fields(json, point_repeatability_fields(), point);
  for (std::size_t source = 0; source < point.sources.size(); ++source) {
    json[std::string(deviation_sources()[source].name)] = source_json(point, source, axis);
  }
  return json;
}

/// The columns of one kind of value. `values(point)` are their statistics at a point.
template <typename Values, typename ValuesAt>
void add_columns(std::vector<layout::PointColumn>& columns, std::span<const PointRepeatability> points,
                 std::span<const RepeatabilityField<Values>> fields, const std::string& prefix,
                 const DeviationSource& source, const ValuesAt& values, bool of_targets) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    for (const ValueStatisticField& statistic : value_statistic_fields()) {
      if (of_targets && !statistic.of_targets) continue;
      layout::PointColumn column{
          fmt::format("{}_{}_{}", prefix, fields[i].name, statistic.name),
          std::string(source.unit),
          fmt::format("{} {}, {}", statistic.long_name, fields[i].long_name, source.long_name),
          {}};
      for (const PointRepeatability& point : points)
        column.values.push_back(statistic.value(values(point)[i]));
      columns.push_back(std::move(column));
    }
  }
}

std::vector<layout::PointColumn> section_columns(const RepeatabilitySummary& summary) {
  using Point = const PointRepeatability&;
  std::vector<layout::PointColumn> columns;
  for (const text::ReportField<PointRepeatability>& field : point_repeatability_fields()) {
    layout::PointColumn column{"repeatability_" + field.name, field.unit, field.long_name, {}};
    for (Point point : summary.points) column.values.push_back(field.value(point));
    columns.push_back(std::move(column));
  }
  for (std::size_t i = 0; i < deviation_sources().size(); ++i) {
    const DeviationSource& source = deviation_sources()[i];
    const std::string prefix = fmt::format("repeatability_{}", source.name);
    add_columns(
        columns, summary.points, axis_fields(), prefix, source,
        [i](Point point) { return std::span(point.sources[i].axis); }, false);
    for (std::size_t target = 0; target < static_cast<std::size_t>(summary.shape.targets); ++target) {
      add_columns(
          columns, summary.points, target_fields(), fmt::format("{}_target_{}", prefix, target), source,
          [i, target](Point point) { return std::span(point.sources[i].targets[target]); }, true);
    }
  }
  return columns;
}

std::vector<layout::PointColumn> on_axis(std::vector<layout::PointColumn> columns,
                                         parameters::AxisKind axis) {
  for (layout::PointColumn& column : columns) column = zerocount::layout::on_axis(std::move(column), axis);
  return columns;
}

}  // namespace

measures::SummarySection repeatability_section(const RepeatabilitySummary& summary,
                                               const std::vector<std::string>& labels) {
  measures::SummarySection section{.key = "repeatability",
                                   .json = {},
                                   .columns = on_axis(section_columns(summary), summary.axis),
                                   .text = repeatability_tables(summary, labels)};
  for (const PointRepeatability& point : summary.points)
    section.json.push_back(point_json(point, summary.axis));
  return section;
}

}  // namespace zerocount::iso230
