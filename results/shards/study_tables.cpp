#include "results/shards/study_tables.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/friction/profile.hpp"
#include "experiments/study/group_inputs.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::shards {
namespace {

std::vector<double> places_over_period(double period, std::int64_t count) {
  std::vector<double> theta(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < theta.size(); ++i) {
    theta[i] = period * static_cast<double>(i) / static_cast<double>(count);
  }
  return theta;
}

void write_one_rotor(hdf5::File& file, const study::RealisedProfile& realised, const study::Study& study) {
  const std::vector<double> theta = places_over_period(study.period, layout::profile_angles);
  std::vector<double> value;
  value.reserve(theta.size());
  for (const double angle : theta) value.push_back(friction::value_at(*realised.profile, angle));
  layout::TableIo io = layout::TableIo::create(
      file, layout::on_axis(layout::profile_table(realised.name, realised.unit), study.units.axis),
      layout::profile_angles, 1);
  io.row_scale().write(0, layout::profile_angles, theta.data());
  io.column(0).write(0, layout::profile_angles, value.data());
}

void write_rotors(hdf5::File& file, const study::RealisedProfile& realised, const study::Study& study) {
  const std::int64_t machines = study.machines;
  const std::int64_t angles = layout::profile_angles_of_machine(realised.profile->cosine.size(), machines);
  const std::vector<double> theta = places_over_period(study.period, angles);
  layout::TableIo io = layout::TableIo::create(
      file, layout::on_axis(layout::rotor_table(realised.name, realised.unit), study.units.axis), machines,
      angles);
  io.number_rows(0);
  io.second_scale().write(0, angles, theta.data());
  const std::int64_t at_once = layout::chunk_rows(angles);
  std::vector<double> values;
  for (std::int64_t first = 0; first < machines; first += at_once) {
    values.clear();
    const std::int64_t count = std::min(at_once, machines - first);
    for (std::int64_t machine = first; machine < first + count; ++machine) {
      const std::shared_ptr<const friction::Profile> rotor = realised.of_machine(machine);
      for (const double angle : theta) values.push_back(friction::value_at(*rotor, angle));
    }
    io.column(0).write(first, count, values.data());
  }
}

/// Unit of the HDF5 dimension scale of a grouping's groups: the unit of ages, otherwise "1".
std::string unit_of(const study::Study& study, const layout::Grouping& grouping) {
  return grouping.has_values ? study.settings.ages.unit : "1";
}

}  // namespace

void write_profiles(hdf5::File& file, const study::Study& study) {
  for (const study::RealisedProfile& realised : study.profiles) {
    if (realised.of_machine) {
      write_rotors(file, realised, study);
    } else {
      write_one_rotor(file, realised, study);
    }
  }
}

void write_groups(hdf5::File& file, const study::Study& study, const layout::Grouping& grouping) {
  const std::int64_t groups = study::group_count(study, grouping.grouping);
  if (groups == 0) return;
  const std::vector<study::InputColumn>& inputs = study.columns.shared[grouping.grouping];
  std::vector<std::vector<double>> values(inputs.size());
  for (std::int64_t group = 0; group < groups && !inputs.empty(); ++group) {
    const std::vector<double> of_group = study::group_inputs(study, grouping.grouping, group);
    for (std::size_t column = 0; column < values.size(); ++column) values[column].push_back(of_group[column]);
  }
  layout::TableIo io = layout::TableIo::create(
      file, layout::group_table(grouping, inputs, unit_of(study, grouping)), groups, 1);
  if (grouping.has_values) {
    io.row_scale().write(0, groups, study.settings.ages.at.data());
  } else {
    io.number_rows(0);
  }
  for (std::size_t column = 0; column < values.size(); ++column)
    io.column(column).write(0, groups, values[column].data());
  if (grouping.has_labels) io.column(values.size()).write_texts(study.settings.conditions);
}

void write_group_counts(hdf5::File& file, const study::Study& study, const layout::Grouping& grouping,
                        const layout::GroupCounts& counts, std::int64_t first) {
  const bool has_goal = !counts.goal_met.empty();
  const auto groups = static_cast<std::size_t>(study::group_count(study, grouping.grouping));
  const layout::Table table =
      layout::group_count_table(grouping, has_goal, counts.statistics, unit_of(study, grouping));
  layout::TableIo io = first > 0 ? layout::TableIo::open(file, table)
                                 : layout::TableIo::create(file, table, study::point_count(study), groups);
  if (first == 0) io.number_rows(0);
  for (std::size_t point = 0; point < counts.trials.size(); ++point) {
    const auto row = first + static_cast<std::int64_t>(point);
    io.column(0).write(row, 1, counts.success[point].data());
    io.column(1).write(row, 1, counts.trials[point].data());
    if (has_goal) io.column(2).write(row, 1, counts.goal_met[point].data());
  }
  std::size_t column = has_goal ? 3 : 2;
  const auto points = static_cast<std::int64_t>(counts.trials.size());
  for (const layout::PointColumn& statistic : counts.statistics)
    io.column(column++).write(first, points, statistic.values.data());
}

}  // namespace zerocount::shards
