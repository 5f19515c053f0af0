#include "experiments/rules/premises.hpp"

#include <algorithm>
#include <string_view>

#include "experiments/study/effects.hpp"

namespace zerocount::rules {
namespace {

study::PremiseState state_of(const study::Effect& effect, const study::StudyPlan& plan) {
  auto state = study::PremiseState::assumed;
  for (std::size_t slot = 0; slot < plan.table.rows.size(); ++slot) {
    const std::string_view name = plan.table.rows[slot].name;
    if (!plan.given[slot] || parameters::without_indices(name) != effect.parameter) continue;
    if (study::acts_somewhere(plan, name)) return study::PremiseState::considered;
    state = study::PremiseState::stated_none;
  }
  return state;
}

bool is_of_the_control_loop(const study::Effect& effect) {
  return effect.parameter.starts_with("encoder.") || effect.parameter.starts_with("controller.");
}

}  // namespace

std::vector<study::Premise> premises_of(const study::StudyPlan& plan) {
  std::vector<study::Premise> premises;
  for (const study::Effect& effect : study::effects()) {
    if (effect.assumption.empty() || (plan.open_loop && is_of_the_control_loop(effect))) continue;
    if (premises.empty() || premises.back().assumption != effect.assumption)
      premises.push_back({effect.assumption});
    premises.back().state = std::min(premises.back().state, state_of(effect, plan));
  }
  // Spectra are not parameters.
  if (!plan.common.disturbance.spectra.empty() || !plan.common.load_side.disturbance.spectra.empty())
    premises.back().state = study::PremiseState::considered;
  return premises;
}

}  // namespace zerocount::rules
