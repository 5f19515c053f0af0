#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "results/layout/layout.hpp"

namespace zerocount::layout {
namespace {

Column whole_numbers(std::string_view name, std::string_view long_name) {
  return {std::string(name), "1", std::string(long_name), hdf5::Element::int64};
}

Column rig_scale() {
  return whole_numbers("rig", "index of the machine");
}

Column world_scale() {
  return whole_numbers("world", "index of the world");
}

Column condition_scale() {
  return whole_numbers("condition", "index of the condition");
}

Column age_scale(const std::string& unit) {
  return {"age", unit, "age of the machines", hdf5::Element::float64};
}

/// Counts of trials in groups, [point, group]. @param where "in the world"
Table group_count_table(std::string name, Column scale, std::string_view where, bool has_goal) {
  const auto counts = [&](std::string_view column, std::string_view which) {
    return whole_numbers(column, fmt::format("trials {} at the point {}", where, which));
  };
  Table table{std::move(name),
              whole_numbers("point", "index of the design point"),
              std::move(scale),
              {counts("success", "that succeeded, in all their moves"),
               counts("trials", "that were judged, 0 in an open loop")}};
  if (has_goal) table.columns.push_back(counts("goal_met", "all of whose moves meet the goal"));
  return table;
}

Column theta_scale() {
  return {"theta", "rad", "$rotor_angle from the origin of the profile", hdf5::Element::float64};
}

Column value_of_profile(const std::string& name, const std::string& unit) {
  return {"value", unit, "realised value of " + name, hdf5::Element::float64};
}

std::vector<Column> input_columns(const std::vector<study::InputColumn>& inputs) {
  std::vector<Column> columns;
  columns.reserve(inputs.size());
  for (const study::InputColumn& input : inputs) {
    columns.push_back({input_column_name(input.name), input.unit, input.meaning, hdf5::Element::float64});
  }
  return columns;
}

template <class Record>
std::vector<Column> columns_of(const std::vector<RecordField<Record>>& fields) {
  std::vector<Column> columns;
  std::transform(fields.begin(), fields.end(), std::back_inserter(columns),
                 [](const RecordField<Record>& entry) { return entry.column; });
  return columns;
}

}  // namespace

Column statistic_column(const PointColumn& statistic) {
  return {statistic.name, statistic.unit, statistic.long_name, hdf5::Element::float64, {}, "statistic"};
}

Table limit_statistic_table(RootDimension limits) {
  return {"point", whole_numbers("point", "index of the design point"), {}, {}, std::move(limits)};
}

Table point_table(const std::vector<study::SweepAxis>& axes, const std::vector<PointColumn>& statistics) {
  Table table{"point", whole_numbers("point", "index of the design point"), {}, {}};
  table.columns.push_back({"label", "1", "name of the design point", hdf5::Element::text});
  for (const study::SweepAxis& axis : axes) {
    const bool text = axis.kind == study::SweepAxis::Kind::text;
    table.columns.push_back({axis.name,
                             text || axis.unit.empty() ? "1" : axis.unit,
                             axis.meaning,
                             text ? hdf5::Element::text : hdf5::Element::float64,
                             {},
                             "axis"});
  }
  for (const PointColumn& statistic : statistics) table.columns.push_back(statistic_column(statistic));
  return table;
}

std::string input_column_name(const std::string& parameter) {
  return "input/" + parameter;
}

Table trial_table(const std::vector<study::InputColumn>& inputs) {
  Table table{
      "trial", whole_numbers("trial", "global row of the trial, point times trials plus index"), {}, {}};
  table.columns.push_back(whole_numbers("point", "index of the design point"));
  table.columns.push_back(whole_numbers("index", "index of the trial within its design point"));
  const std::vector<Column> columns = input_columns(inputs);
  table.columns.insert(table.columns.end(), columns.begin(), columns.end());
  return table;
}

Table outcome_table(const study::StudyFeatures& features, const MeasureTable& measures) {
  return {"outcome", whole_numbers("trial", "global row of the trial"),
          whole_numbers("move", "index of the move"), columns_of(move_fields(features, measures))};
}

RootDimension band_dimension(const trial::ErrorBands& bands) {
  return {{"band", "count", "error band: largest absolute error within it", hdf5::Element::int64},
          {bands.values().begin(), bands.values().end()}};
}

Table band_table(const trial::ErrorBands& bands) {
  return {"outcome", whole_numbers("trial", "global row of the trial"),
          whole_numbers("move", "index of the move"), columns_of(band_fields()), band_dimension(bands)};
}

RootDimension tolerance_dimension(const trial::Tolerances& tolerances) {
  return {{"tolerance", "rad", "largest position error within the tolerance", hdf5::Element::float64},
          {tolerances.values().begin(), tolerances.values().end()}};
}

Table tolerance_table(const trial::Tolerances& tolerances) {
  return {"outcome", whole_numbers("trial", "global row of the trial"),
          whole_numbers("move", "index of the move"), columns_of(tolerance_fields()),
          tolerance_dimension(tolerances)};
}

Table verdict_table() {
  Table table = outcome_table();
  std::erase_if(table.columns, [](const Column& column) { return column.name != "outcome"; });
  return table;
}

Table jerk_table() {
  return {"jerk",
          whole_numbers("jerk", "index of the jerk, by trial, move and onset"),
          {},
          columns_of(jerk_fields())};
}

Table trace_table(const study::StudyFeatures& features) {
  return {"trace",
          whole_numbers("record", "index of the record, by trial and sample"),
          {},
          columns_of(trace_fields(features))};
}

std::span<const StatisticGroup> statistic_groups() {
  static constexpr std::array<StatisticGroup, 1> groups{
      {{"level", "move", "index of the move", "levels.csv"}}};
  return groups;
}

const StatisticGroup& level_group() {
  return statistic_groups()[0];
}

Table statistic_table(const StatisticGroup& group, const std::vector<PointColumn>& columns) {
  Table table{std::string(group.name),
              whole_numbers("point", "index of the design point"),
              whole_numbers(group.dimension, group.meaning),
              {}};
  for (const PointColumn& column : columns) table.columns.push_back(statistic_column(column));
  return table;
}

Table on_axis(Table table, parameters::AxisKind axis) {
  const auto reword = [axis](Column& column) {
    column.unit = parameters::unit_on(axis, column.unit);
    column.long_name = parameters::text_on(axis, column.long_name);
  };
  reword(table.rows);
  if (table.second) reword(*table.second);
  if (table.last) reword(table.last->scale);
  for (Column& column : table.columns) reword(column);
  return table;
}

PointColumn on_axis(PointColumn column, parameters::AxisKind axis) {
  column.unit = parameters::unit_on(axis, column.unit);
  column.long_name = parameters::text_on(axis, column.long_name);
  return column;
}

std::int64_t profile_angles_of_rig(std::size_t harmonics, std::int64_t rigs) {
  constexpr std::int64_t min_angles = 64;
  constexpr std::int64_t max_values = std::int64_t{1} << 22;
  const std::int64_t wanted = 8 * static_cast<std::int64_t>(harmonics);
  const std::int64_t needed = 2 * static_cast<std::int64_t>(harmonics);
  std::int64_t angles = min_angles;
  while (angles < std::min(wanted, profile_angles)) angles *= 2;
  while (angles * rigs > max_values && angles / 2 >= std::max(needed, min_angles)) angles /= 2;
  return angles;
}

Table profile_table(const std::string& name, const std::string& unit) {
  return {"profile/" + name, theta_scale(), {}, {value_of_profile(name, unit)}};
}

Table rotor_table(const std::string& name, const std::string& unit) {
  return {"profile/" + name, rig_scale(), theta_scale(), {value_of_profile(name, unit)}};
}

Table rig_table(const std::vector<study::InputColumn>& inputs) {
  return {"rig", rig_scale(), {}, input_columns(inputs)};
}

Table rig_count_table() {
  return {
      "rig",
      whole_numbers("point", "index of the design point"),
      rig_scale(),
      {whole_numbers("success", "trials of the machine at the point that succeeded, in all their moves"),
       whole_numbers("trials", "trials of the machine at the point that were judged, 0 in an open loop")}};
}

Table world_table(const std::vector<study::InputColumn>& inputs) {
  return {"world", world_scale(), {}, input_columns(inputs)};
}

Table world_count_table(bool has_goal) {
  return group_count_table("world", world_scale(), "in the world", has_goal);
}

Table condition_table() {
  return {"condition", condition_scale(), {}, {{"name", "1", "name of the condition", hdf5::Element::text}}};
}

Table condition_count_table(bool has_goal) {
  return group_count_table("condition", condition_scale(), "under the condition", has_goal);
}

Table age_table(const std::string& unit) {
  return {"age", age_scale(unit), {}, {}};
}

Table age_count_table(const std::string& unit, bool has_goal) {
  Table table = group_count_table("age", age_scale(unit), "at the age", has_goal);
  const auto proportion = [&](std::string_view name, std::string_view meaning) {
    table.columns.push_back({std::string(name), "1", std::string(meaning), hdf5::Element::float64});
  };
  if (!has_goal) return table;
  proportion("machines", "proportion of machines that meet the goal at the age under every condition");
  proportion("machines_low", "lower bound of the proportion of machines, one-sided");
  proportion("machines_high", "upper bound of the proportion of machines, one-sided");
  return table;
}

Table life_table(const std::string& unit) {
  return {
      "rig",
      whole_numbers("point", "index of the design point"),
      rig_scale(),
      {{"life", unit,
        "last age up to and including which the machine meets the goal under every condition, NaN if it does "
        "not at the first",
        hdf5::Element::float64}}};
}

Table sums_table() {
  return {"sums",
          whole_numbers("point", "index of the design point"),
          {},
          {whole_numbers("whole_count", "elements of whole that belong to the point"),
           whole_numbers("real_count", "elements of real that belong to the point")}};
}

Table whole_sums_table() {
  return {"sums",
          whole_numbers("whole_index", "index among the whole numbers of all points"),
          {},
          {whole_numbers("whole", "counts and digits of the sums")}};
}

Table real_sums_table() {
  return {"sums",
          whole_numbers("real_index", "index among the real numbers of all points"),
          {},
          {{"real", "1", "distinct values of the sums, each in its unit", hdf5::Element::float64}}};
}

}  // namespace zerocount::layout
