#include "experiments/manifest/study_units_reading.hpp"

namespace zerocount::manifest {
void read_study_units(const yaml::Field& root, Reading& reading) {
  study::StudyPlan& plan = reading.plan;
  if (const auto axis = yaml::find_field(root, "axis")) {
    plan.units.axis = static_cast<parameters::AxisKind>(
        yaml::read_label(*axis, parameters::axis_labels, reading.problems).value_or(0));
  }
  const bool linear = plan.units.axis == parameters::AxisKind::linear;
  if (linear) plan.period.reset();
  if (const auto travel = yaml::find_field(root, "travel")) {
    const auto length = yaml::read_real(*travel, numerics::above(0), reading.problems);
    if (linear) {
      plan.period = length;
    } else {
      reading.problems.add(*travel,
                           "a rotary axis has no travel: what varies along it has the period of a revolution",
                           "axis: linear, or the key left out");
    }
  }
  const auto controller = yaml::find_field(root, "controller");
  const auto gains = controller ? yaml::find_field(*controller, "units") : std::nullopt;
  if (gains)
    plan.units.gains = static_cast<parameters::GainUnits>(
        yaml::read_label(*gains, parameters::gain_unit_labels, reading.problems).value_or(0));
}

void check_travel(const yaml::Field& root, Reading& reading) {
  const auto travel = yaml::find_field(root, "travel");
  if (!travel || !reading.profiles.empty() || reading.plan.units.axis == parameters::AxisKind::rotary) return;
  reading.warnings.push_back(yaml::at_place(
      travel->node->place, travel->path, "it has no effect: no parameter of friction is a profile along it"));
}

}  // namespace zerocount::manifest
