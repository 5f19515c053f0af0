#include "results/reading/trial_tables.hpp"

#include <string>

#include "results/layout/measure_table.hpp"

namespace zerocount::reading {

std::vector<study::InputColumn> read_input_columns(const hdf5::Group& table) {
  std::vector<study::InputColumn> inputs;
  if (!table.contains("input")) return inputs;
  const hdf5::Group group = table.open_group("input");
  for (const std::string& name : group.children()) {
    const hdf5::Dataset dataset = group.open_dataset(name);
    inputs.push_back({name, dataset.text("units"), dataset.text("long_name")});
  }
  return inputs;
}

study::StudyFeatures read_features(const hdf5::File& file, const layout::MeasureTable& table) {
  const hdf5::Group outcome = file.open_group("outcome");
  study::StudyFeatures features;
  if (outcome.open_dataset("final_position").text("units") ==
      parameters::unit_on(parameters::AxisKind::linear, "rad"))
    features.axis = parameters::AxisKind::linear;
  for (const layout::Measure& measure : table) {
    if (measure.file.only_with != nullptr)
      features.*measure.file.only_with = outcome.contains(measure.field.column.name);
  }
  if (!file.contains("trace")) return features;
  const hdf5::Group trace = file.open_group("trace");
  features.travel = trace.contains("reference");
  features.phases = trace.contains("phase");
  features.load = trace.contains("load_theta");
  features.drive_torque = trace.contains("drive_torque");
  return features;
}

std::int64_t first_not_below(const hdf5::Dataset& numbers, std::int64_t size, std::int64_t number) {
  std::int64_t low = 0;
  std::int64_t high = size;
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    std::int64_t value = 0;
    numbers.read(middle, 1, &value);
    if (value < number) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

}  // namespace zerocount::reading
