#include "analysis/iso230/repeatability_layout.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/iso230/repeatability_fields.hpp"
#include "analysis/iso230/repeatability_statistics.hpp"

namespace zerocount::iso230 {
namespace {

layout::Column numbers(const std::string& name, std::string_view unit, const std::string& long_name) {
  return {name, std::string(unit), long_name, hdf5::Element::float64, {}, {}};
}

layout::Column scale(const char* name, const char* long_name) {
  return {name, "1", long_name, hdf5::Element::int64, {}, {}};
}

layout::Column rows_of_trials() {
  return scale("trial", "global row of the trial");
}
layout::Column rows_of_points() {
  return scale("point", "index of the design point");
}
layout::Column targets_of_list() {
  return scale("target", "index of the target in its list");
}

/// A column for every value of `fields`, from every source.
template <typename Values>
void add_values(std::vector<layout::Column>& columns, std::span<const RepeatabilityField<Values>> fields) {
  for (const DeviationSource& source : deviation_sources()) {
    for (const RepeatabilityField<Values>& field : fields) {
      columns.push_back(numbers(fmt::format("{}/{}", source.name, field.name), source.unit,
                                fmt::format("{}, {}", field.long_name, source.long_name)));
    }
  }
}

/// A column for every statistic of every value of `fields`, from every source.
template <typename Values>
void add_statistics(std::vector<layout::Column>& columns, std::span<const RepeatabilityField<Values>> fields,
                    bool of_targets) {
  for (const DeviationSource& source : deviation_sources()) {
    for (const RepeatabilityField<Values>& field : fields) {
      for (const ValueStatisticField& statistic : value_statistic_fields()) {
        if (of_targets && !statistic.of_targets) continue;
        columns.push_back(
            numbers(fmt::format("{}/{}_{}", source.name, field.name, statistic.name), source.unit,
                    fmt::format("{} {}, {}", statistic.long_name, field.long_name, source.long_name)));
      }
    }
  }
}

}  // namespace

layout::Table trial_table_of_axis() {
  layout::Table table{"repeatability/trial", rows_of_trials(), {}, {}};
  table.columns.push_back({"evaluated",
                           "1",
                           "the trial has no nonfinite move, and so has values",
                           hdf5::Element::flag,
                           {{0, "no"}, {1, "yes"}},
                           {}});
  add_values(table.columns, axis_fields());
  return table;
}

layout::Table trial_table_of_targets() {
  layout::Table table{"repeatability/trial_target", rows_of_trials(), targets_of_list(), {}};
  table.columns.push_back(numbers("position", "count", "the target, from the start of the trial"));
  add_values(table.columns, target_fields());
  return table;
}

layout::Table point_table_of_axis() {
  layout::Table table{"repeatability/point", rows_of_points(), {}, {}};
  for (const text::ReportField<PointRepeatability>& field : point_repeatability_fields()) {
    table.columns.push_back(numbers(field.name, "1", field.long_name));
  }
  add_statistics(table.columns, axis_fields(), false);
  return table;
}

layout::Table point_table_of_targets() {
  layout::Table table{"repeatability/point_target", rows_of_points(), targets_of_list(), {}};
  table.columns.push_back(numbers("position_min", "count", "smallest position of the target in a trial"));
  table.columns.push_back(numbers("position_max", "count", "largest position of the target in a trial"));
  add_statistics(table.columns, target_fields(), true);
  return table;
}

}  // namespace zerocount::iso230
