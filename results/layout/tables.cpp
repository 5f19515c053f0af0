#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "results/layout/groupings.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::layout {
namespace {

Column whole_numbers(std::string_view name, std::string_view long_name) {
  return {std::string(name), "1", std::string(long_name), hdf5::Element::int64};
}

Column theta_scale() {
  return {"theta", "rad", "$rotor_angle from the origin of the profile", hdf5::Element::float64};
}

Column value_of_profile(const std::string& name, const std::string& unit) {
  return {"value", unit, "realised value of " + name, hdf5::Element::float64};
}

template <class Record>
std::vector<Column> columns_of(const std::vector<RecordField<Record>>& fields) {
  std::vector<Column> columns;
  std::transform(fields.begin(), fields.end(), std::back_inserter(columns),
                 [](const RecordField<Record>& entry) { return entry.column; });
  return columns;
}

}  // namespace

Column point_scale() {
  return whole_numbers("point", "index of the design point");
}

std::vector<Column> input_columns(const std::vector<study::InputColumn>& inputs) {
  std::vector<Column> columns;
  columns.reserve(inputs.size());
  for (const study::InputColumn& input : inputs) {
    columns.push_back({input_column_name(input.name), input.unit, input.meaning, hdf5::Element::float64});
  }
  return columns;
}

Column statistic_column(const PointColumn& statistic) {
  return {statistic.name, statistic.unit, statistic.long_name, hdf5::Element::float64, {}, "statistic"};
}

Table limit_statistic_table(RootDimension limits) {
  return {"point", point_scale(), {}, {}, std::move(limits)};
}

Table point_table(const std::vector<study::SweepAxis>& axes, const std::vector<PointColumn>& statistics) {
  Table table{"point", point_scale(), {}, {}};
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

Table tolerance_table(const study::StudyFeatures& features) {
  return {"outcome", whole_numbers("trial", "global row of the trial"),
          whole_numbers("move", "index of the move"), columns_of(tolerance_fields(features)),
          tolerance_dimension(features.tolerances)};
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
  Table table{std::string(group.name), point_scale(), whole_numbers(group.dimension, group.meaning), {}};
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

std::int64_t profile_angles_of_machine(std::size_t harmonics, std::int64_t machines) {
  constexpr std::int64_t min_angles = 64;
  constexpr std::int64_t max_values = std::int64_t{1} << 22;
  const std::int64_t wanted = 8 * static_cast<std::int64_t>(harmonics);
  const std::int64_t needed = 2 * static_cast<std::int64_t>(harmonics);
  std::int64_t angles = min_angles;
  while (angles < std::min(wanted, profile_angles)) angles *= 2;
  while (angles * machines > max_values && angles / 2 >= std::max(needed, min_angles)) angles /= 2;
  return angles;
}

Table profile_table(const std::string& name, const std::string& unit) {
  return {"profile/" + name, theta_scale(), {}, {value_of_profile(name, unit)}};
}

Table rotor_table(const std::string& name, const std::string& unit) {
  return {"profile/" + name,
          group_scale(grouping_named("machine"), "1"),
          theta_scale(),
          {value_of_profile(name, unit)}};
}

Table sums_table() {
  return {"sums",
          point_scale(),
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
