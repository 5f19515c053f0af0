#include <algorithm>
#include <cstddef>

#include "experiments/randomness/random_variables.hpp"
#include "experiments/study/effects.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::randomness {
namespace {

bool is_drawn_somewhere(const study::StudyPlan& plan, std::size_t slot) {
  const std::vector<const study::Value*> values = study::values_of(plan, slot);
  return std::any_of(values.begin(), values.end(), [](const study::Value* value) {
    return value->kind == study::Value::Kind::distribution && value->level != study::DrawLevel::study;
  });
}

// Whether trials use random numbers while they run; see core/random/random_numbers.hpp.
bool draws_within_trials(const study::StudyPlan& plan) {
  return std::ranges::any_of(study::effects(), [&](const study::Effect& effect) {
    return effect.draws != nullptr && study::acts(plan, effect);
  });
}

}  // namespace

study::TrialFactors find_factors(const study::StudyPlan& plan) {
  study::TrialFactors factors;
  for (const std::size_t slot : study::slots_in_table_order(plan.table)) {
    if (is_drawn_somewhere(plan, slot)) factors.slots.push_back(static_cast<std::uint32_t>(slot));
  }
  factors.within_trial = draws_within_trials(plan);
  return factors;
}

std::vector<std::string> factor_names(const study::StudyPlan& plan) {
  const study::TrialFactors factors = find_factors(plan);
  std::vector<std::string> names;
  for (const std::uint32_t slot : factors.slots) names.emplace_back(plan.table.rows[slot].name);
  if (factors.within_trial) names.emplace_back(study::within_trial_factor);
  return names;
}

}  // namespace zerocount::randomness
