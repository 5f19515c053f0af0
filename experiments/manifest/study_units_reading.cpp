#include "experiments/manifest/study_units_reading.hpp"

namespace zerocount::manifest {
namespace {

std::optional<yaml::Field> find_within(const yaml::Field& map, std::string_view key) {
  if (map.node->kind != yaml::YamlNode::Kind::map) return std::nullopt;
  const yaml::YamlEntry* entry = yaml::find_entry(*map.node, key);
  if (entry == nullptr) return std::nullopt;
  return yaml::entry_of(map, *entry);
}

}  // namespace

void read_study_units(const yaml::Field& root, Reading& reading) {
  study::StudyPlan& plan = reading.plan;
  if (const auto axis = find_within(root, "axis")) {
    plan.units.axis = static_cast<parameters::AxisKind>(
        yaml::read_label(*axis, parameters::axis_labels(), reading.problems).value_or(0));
  }
  const bool linear = plan.units.axis == parameters::AxisKind::linear;
  if (linear) plan.period.reset();
  if (const auto travel = find_within(root, "travel")) {
    const auto length = yaml::read_real(*travel, numerics::above(0), reading.problems);
    if (linear) {
      plan.period = length;
    } else {
      reading.problems.add(travel->node->place, travel->path,
                           "a rotary axis has no travel: what varies along it has the period of a revolution",
                           "axis: linear, or the key left out");
    }
  }
  const auto controller = find_within(root, "controller");
  const auto gains = controller ? find_within(*controller, "units") : std::nullopt;
  if (gains)
    plan.units.gains = static_cast<parameters::GainUnits>(
        yaml::read_label(*gains, parameters::gain_unit_labels(), reading.problems).value_or(0));
}

void check_travel(const yaml::Field& root, Reading& reading) {
  const auto travel = find_within(root, "travel");
  if (!travel || !reading.profiles.empty() || reading.plan.units.axis == parameters::AxisKind::rotary) return;
  reading.warnings.push_back(yaml::at_place(
      travel->node->place, travel->path, "it has no effect: no parameter of friction is a profile along it"));
}

}  // namespace zerocount::manifest
