#include "results/shards/rig_tables.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
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
  const std::int64_t rigs = study.rigs;
  const std::int64_t angles = layout::profile_angles_of_rig(realised.profile->cosine.size(), rigs);
  const std::vector<double> theta = places_over_period(study.period, angles);
  layout::TableIo io = layout::TableIo::create(
      file, layout::on_axis(layout::rotor_table(realised.name, realised.unit), study.units.axis), rigs,
      angles);
  io.number_rows(0);
  io.second_scale().write(0, angles, theta.data());
  const std::int64_t at_once = layout::chunk_rows(angles);
  std::vector<double> values;
  for (std::int64_t first = 0; first < rigs; first += at_once) {
    values.clear();
    const std::int64_t count = std::min(at_once, rigs - first);
    for (std::int64_t rig = first; rig < first + count; ++rig) {
      const std::shared_ptr<const friction::Profile> rotor = realised.of_rig(rig);
      for (const double angle : theta) values.push_back(friction::value_at(*rotor, angle));
    }
    io.column(0).write(first, count, values.data());
  }
}

/// Writes a table of inputs. @param inputs_of its row → [column]
void write_inputs(hdf5::File& file, const layout::Table& table, std::int64_t rows,
                  const std::function<std::vector<double>(std::int64_t)>& inputs_of) {
  std::vector<std::vector<double>> values(table.columns.size());
  for (std::int64_t row = 0; row < rows; ++row) {
    const std::vector<double> inputs = inputs_of(row);
    for (std::size_t column = 0; column < values.size(); ++column) values[column].push_back(inputs[column]);
  }
  layout::TableIo io = layout::TableIo::create(file, table, rows, 1);
  io.number_rows(0);
  for (std::size_t column = 0; column < values.size(); ++column)
    io.column(column).write(0, rows, values[column].data());
}

/// The table of counts [point, width], which the first points create.
layout::TableIo table_of_counts(hdf5::File& file, const layout::Table& table, const study::Study& study,
                                std::int64_t width, std::int64_t first) {
  if (first > 0) return layout::TableIo::open(file, table);
  layout::TableIo io = layout::TableIo::create(file, table, study::point_count(study), width);
  io.number_rows(0);
  return io;
}

void write_group_counts(layout::TableIo& io, const layout::GroupCounts& counts, std::int64_t first) {
  for (std::size_t point = 0; point < counts.trials.size(); ++point) {
    const auto row = first + static_cast<std::int64_t>(point);
    io.column(0).write(row, 1, counts.success[point].data());
    io.column(1).write(row, 1, counts.trials[point].data());
    if (!counts.goal_met.empty()) io.column(2).write(row, 1, counts.goal_met[point].data());
  }
}

}  // namespace

void write_profiles(hdf5::File& file, const study::Study& study) {
  for (const study::RealisedProfile& realised : study.profiles) {
    if (realised.of_rig) {
      write_rotors(file, realised, study);
    } else {
      write_one_rotor(file, realised, study);
    }
  }
}

void write_rigs(hdf5::File& file, const study::Study& study) {
  write_inputs(file, layout::rig_table(study.columns.shared[study::Grouping::rig]), study.rigs,
               [&](std::int64_t rig) { return study::group_inputs(study, study::Grouping::rig, rig); });
}

void write_worlds(hdf5::File& file, const study::Study& study) {
  write_inputs(file, layout::world_table(study.columns.shared[study::Grouping::world]), study.worlds,
               [&](std::int64_t world) { return study::group_inputs(study, study::Grouping::world, world); });
}

void write_world_counts(hdf5::File& file, const study::Study& study, const layout::GroupCounts& counts,
                        std::int64_t first) {
  layout::TableIo io =
      table_of_counts(file, layout::world_count_table(!counts.goal_met.empty()), study, study.worlds, first);
  write_group_counts(io, counts, first);
}

void write_conditions(hdf5::File& file, const study::Study& study) {
  layout::TableIo io =
      layout::TableIo::create(file, layout::condition_table(), std::ssize(study.condition_names), 1);
  io.number_rows(0);
  io.column(0).write_texts(study.condition_names);
}

void write_condition_counts(hdf5::File& file, const study::Study& study, const layout::GroupCounts& counts,
                            std::int64_t first) {
  layout::TableIo io = table_of_counts(file, layout::condition_count_table(!counts.goal_met.empty()), study,
                                       std::ssize(study.condition_names), first);
  write_group_counts(io, counts, first);
}

void write_ages(hdf5::File& file, const study::Study& study) {
  const std::int64_t ages = std::ssize(study.ages.at);
  layout::TableIo::create(file, layout::age_table(study.ages.unit), ages, 1)
      .row_scale()
      .write(0, ages, study.ages.at.data());
}

void write_age_counts(hdf5::File& file, const study::Study& study, const layout::AgeCounts& counts,
                      std::int64_t first) {
  const bool has_goal = !counts.machines.empty();
  layout::TableIo io = table_of_counts(file, layout::age_count_table(study.ages.unit, has_goal), study,
                                       std::ssize(study.ages.at), first);
  write_group_counts(io, counts.trials, first);
  if (!has_goal) return;
  layout::TableIo lives =
      table_of_counts(file, layout::life_table(study.ages.unit), study, study.rigs, first);
  for (std::size_t point = 0; point < counts.lives.size(); ++point) {
    const auto row = first + static_cast<std::int64_t>(point);
    io.column(3).write(row, 1, counts.machines[point].data());
    io.column(4).write(row, 1, counts.machines_low[point].data());
    io.column(5).write(row, 1, counts.machines_high[point].data());
    lives.column(0).write(row, 1, counts.lives[point].data());
  }
}

void write_rig_counts(hdf5::File& file, const study::Study& study,
                      const std::vector<std::vector<std::int64_t>>& successes, std::int64_t first) {
  layout::TableIo io = table_of_counts(file, layout::rig_count_table(), study, study.rigs, first);
  const std::vector<std::int64_t> trials(static_cast<std::size_t>(study.rigs),
                                         study.open_loop ? 0 : study.trials / study.rigs);
  for (std::size_t point = 0; point < successes.size(); ++point) {
    const auto row = first + static_cast<std::int64_t>(point);
    io.column(0).write(row, 1, successes[point].data());
    io.column(1).write(row, 1, trials.data());
  }
}

}  // namespace zerocount::shards
