#include "results/shards/rig_tables.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/friction/profile.hpp"
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
  std::vector<std::vector<double>> values(study.rig_columns.size());
  for (std::int64_t rig = 0; rig < study.rigs; ++rig) {
    const std::vector<double> inputs = study::rig_inputs(study, rig);
    for (std::size_t column = 0; column < values.size(); ++column) values[column].push_back(inputs[column]);
  }
  layout::TableIo io = layout::TableIo::create(file, layout::rig_table(study.rig_columns), study.rigs, 1);
  io.number_rows(0);
  for (std::size_t column = 0; column < values.size(); ++column) {
    io.column(column).write(0, study.rigs, values[column].data());
  }
}

void write_rig_counts(hdf5::File& file, const study::Study& study,
                      const std::vector<std::vector<std::int64_t>>& successes) {
  layout::TableIo io =
      layout::TableIo::create(file, layout::rig_count_table(), std::ssize(successes), study.rigs);
  io.number_rows(0);
  const std::vector<std::int64_t> trials(static_cast<std::size_t>(study.rigs),
                                         study.open_loop ? 0 : study.trials / study.rigs);
  for (std::size_t point = 0; point < successes.size(); ++point) {
    io.column(0).write(static_cast<std::int64_t>(point), 1, successes[point].data());
    io.column(1).write(static_cast<std::int64_t>(point), 1, trials.data());
  }
}

}  // namespace zerocount::shards
