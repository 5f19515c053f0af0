#include <cstddef>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "analysis/iso230/repeatability_columns.hpp"
#include "analysis/iso230/repeatability_statistics.hpp"
#include "analysis/measures/summary_section.hpp"
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

std::vector<layout::PointColumn> section_columns(const RepeatabilitySummary& summary) {
  std::vector<layout::PointColumn> columns;
  const auto add = [&](const std::string& prefix, const auto& all, std::string_view source,
                       std::size_t target) {
    for (const RepeatabilityColumn<PointRepeatability>& column : all) {
      if (column.source != source) continue;
      layout::PointColumn& added = columns.emplace_back(layout::on_axis(
          layout::PointColumn{prefix + column.name, std::string(column.unit), column.long_name, {}},
          summary.axis));
      for (const PointRepeatability& point : summary.points)
        added.values.push_back(column.value(point, target));
    }
  };
  add("repeatability_", point_axis_columns(), "", 0);
  for (const DeviationSource& source : deviation_sources()) {
    const std::string prefix = fmt::format("repeatability_{}_", source.name);
    add(prefix, point_axis_columns(), source.name, 0);
    for (std::size_t target = 0; target < static_cast<std::size_t>(summary.shape.targets); ++target)
      add(fmt::format("{}target_{}_", prefix, target), point_target_columns(), source.name, target);
  }
  return columns;
}

}  // namespace

measures::SummarySection repeatability_section(const RepeatabilitySummary& summary,
                                               const std::vector<std::string>& labels) {
  measures::SummarySection section{
      .key = "repeatability", .json = {}, .columns = section_columns(summary), .open = true};
  add_tables(section, summary, labels);
  for (const PointRepeatability& point : summary.points)
    section.json.push_back(point_json(point, summary.axis));
  return section;
}

}  // namespace zerocount::iso230
