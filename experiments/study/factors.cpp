#include "experiments/study/factors.hpp"

#include <algorithm>
#include <array>

#include "experiments/study/point_limits.hpp"
#include "experiments/study/study.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::study {
namespace {

bool is_drawn_somewhere(const StudyPlan& plan, std::size_t slot) {
  const std::vector<const Value*> values = values_of(plan, slot);
  return std::any_of(values.begin(), values.end(), [](const Value* value) {
    return value->kind == Value::Kind::distribution && value->level != DrawLevel::study;
  });
}

// Whether trials use random numbers while they run; see core/random/trial_randomness.hpp.
bool draws_within_trials(const StudyPlan& plan) {
  const auto above_zero = [](const ValueLimits& limits) { return limits.high > 0.0; };
  constexpr std::array<std::string_view, 7> noises{"encoder.fine_errors.noise",
                                                   "encoder.fine_errors.missed",
                                                   "encoder.coarse_errors.noise",
                                                   "encoder.coarse_errors.missed",
                                                   "dac.noise",
                                                   "controller.missed",
                                                   "controller.jitter"};
  constexpr std::array<std::string_view, 2> history{"initial.history.reversals", "initial.history.torque"};
  return !plan.common.disturbance.spectra.empty() ||
         holds_somewhere(
             plan, history,
             [&](std::span<const ValueLimits> l) { return std::all_of(l.begin(), l.end(), above_zero); }) ||
         std::any_of(noises.begin(), noises.end(),
                     [&](std::string_view noise) { return holds_somewhere(plan, noise, above_zero); });
}

}  // namespace

TrialFactors find_factors(const StudyPlan& plan) {
  TrialFactors factors;
  for (const std::size_t slot : slots_in_table_order(plan.table)) {
    if (is_drawn_somewhere(plan, slot)) factors.slots.push_back(static_cast<std::uint32_t>(slot));
  }
  factors.within_trial = draws_within_trials(plan);
  return factors;
}

std::vector<std::string> factor_names(const StudyPlan& plan) {
  const TrialFactors factors = find_factors(plan);
  std::vector<std::string> names;
  for (const std::uint32_t slot : factors.slots) names.emplace_back(plan.table.rows[slot].name);
  if (factors.within_trial) names.emplace_back(within_trial_factor);
  return names;
}

}  // namespace zerocount::study
