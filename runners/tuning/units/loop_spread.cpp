#include "runners/tuning/units/loop_spread.hpp"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <utility>

#include "experiments/study/plan.hpp"

namespace zerocount::tuning {
namespace {

/// Replaces each machine by two, with the factors 1 − part and 1 + part.
template <class Scale>
void spread_by(const std::optional<double>& part, std::vector<trial::TrialParameters>& machines,
               const Scale& scale) {
  if (part.value_or(0.0) == 0.0) return;
  std::vector<trial::TrialParameters> spread;
  spread.reserve(2 * machines.size());
  for (const trial::TrialParameters& machine : machines) {
    for (const double factor : {1.0 - *part, 1.0 + *part}) {
      spread.push_back(machine);
      scale(spread.back(), factor);
    }
  }
  machines = std::move(spread);
}

}  // namespace

study::LoopSpread spread_of_undrawn(const study::Study& study, std::int64_t condition) {
  if (!study.tuning) return {std::nullopt, std::nullopt, std::nullopt};
  study::LoopSpread spread = study.tuning->margins.spread;
  const auto is_drawn = [&](std::initializer_list<std::string_view> names) {
    return draws(study, condition,
                 [&](std::string_view name) { return std::ranges::find(names, name) != names.end(); });
  };
  if (is_drawn({"plant.inertia", "plant.load.inertia"})) spread.inertia.reset();
  if (is_drawn({"plant.presliding_damping", "plant.sliding_damping"})) spread.damping.reset();
  if (is_drawn({"dac.gain_error"})) spread.torque_constant.reset();
  return spread;
}

std::vector<trial::TrialParameters> corners_of(const trial::TrialParameters& machine,
                                               const study::LoopSpread& spread) {
  std::vector<trial::TrialParameters> machines{machine};
  spread_by(spread.inertia, machines, [](trial::TrialParameters& p, double factor) {
    p.plant.inertia *= factor;
    p.plant.load.inertia *= factor;
  });
  spread_by(spread.damping, machines, [](trial::TrialParameters& p, double factor) {
    p.plant.presliding_damping *= factor;
    p.plant.sliding_damping *= factor;
  });
  spread_by(spread.torque_constant, machines, [](trial::TrialParameters& p, double factor) {
    p.dac.gain_error = (1.0 + p.dac.gain_error) * factor - 1.0;
  });
  return machines;
}

std::vector<std::size_t> likely_worst_corners(const study::LoopSpread& spread) {
  const auto is_spread = [](const std::optional<double>& part) { return part.value_or(0.0) != 0.0; };
  const std::size_t torques = is_spread(spread.torque_constant) ? 2 : 1;
  const std::size_t dampings = is_spread(spread.damping) ? 2 : 1;
  const std::size_t highest_torque = torques - 1;
  if (!is_spread(spread.inertia)) return {highest_torque};
  return {highest_torque, dampings * torques + highest_torque};
}

}  // namespace zerocount::tuning
