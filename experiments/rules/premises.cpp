#include "experiments/rules/premises.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "experiments/study/point_limits.hpp"

namespace zerocount::rules {
namespace {

/// An effect, by the assumption that it is absent.
struct PremiseRow {
  std::string_view assumption;
  std::vector<std::string_view> keys;  ///< parameters that are 0 without it; "#": of any element of a list
  bool closed_loop{true};              ///< it acts in the control loop alone
};

const std::vector<PremiseRow>& premise_table() {
  static const std::vector<PremiseRow> table{
      {"no encoder noise", {"encoder.fine_errors.noise", "encoder.coarse_errors.noise"}},
      {"no other encoder errors",
       {"encoder.fine_errors.eccentricity", "encoder.fine_errors.interpolation", "encoder.fine_errors.missed",
        "encoder.coarse_errors.eccentricity", "encoder.coarse_errors.interpolation",
        "encoder.coarse_errors.missed"}},
      {"no delay", {"controller.delay"}},
      {"no jitter", {"controller.jitter"}},
      {"ideal amplifier", {"amplifier.bandwidth"}, false},
      {"ideal converter", {"dac.offset", "dac.gain_error", "dac.nonlinearity", "dac.noise"}, false},
      {"rigid", {"plant.load.inertia"}, false},
      {"no disturbance",
       {"disturbance.torque", "disturbance.ripple.#.amplitude", "disturbance.vibration.#.amplitude"},
       false}};
  return table;
}

/// Whether the name is the key's, the number of an element standing for its "#".
bool is_named(std::string_view name, std::string_view key) {
  const std::size_t mark = key.find('#');
  if (mark == std::string_view::npos) return name == key;
  if (name.size() <= mark || !name.starts_with(key.substr(0, mark))) return false;
  const std::size_t end = name.find('.', mark);
  return end != std::string_view::npos && name.substr(end) == key.substr(mark + 1);
}

bool can_differ_from_zero(const study::StudyPlan& plan, std::size_t slot) {
  bool found = false;
  study::visit_points(plan, std::span(&slot, 1), [&](std::size_t point) {
    const study::ValueLimits limits = study::limits_of_slot(plan, slot, point);
    found = limits.low != 0.0 || limits.high != 0.0;
    return !found;
  });
  return found;
}

study::PremiseState state_of(const PremiseRow& row, const study::StudyPlan& plan) {
  auto state = study::PremiseState::assumed;
  for (std::size_t slot = 0; slot < plan.table.rows.size(); ++slot) {
    const std::string_view name = plan.table.rows[slot].name;
    if (std::ranges::none_of(row.keys, [&](std::string_view key) { return is_named(name, key); })) continue;
    if (!plan.given[slot]) continue;
    if (can_differ_from_zero(plan, slot)) return study::PremiseState::considered;
    state = study::PremiseState::stated_none;
  }
  return state;
}

}  // namespace

std::vector<study::Premise> premises_of(const study::StudyPlan& plan) {
  std::vector<study::Premise> premises;
  for (const PremiseRow& row : premise_table()) {
    if (row.closed_loop && plan.open_loop) continue;
    premises.push_back({row.assumption, state_of(row, plan)});
  }
  // Spectra are not parameters.
  if (!plan.common.disturbance.spectra.empty()) premises.back().state = study::PremiseState::considered;
  return premises;
}

}  // namespace zerocount::rules
