#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"

/// What the machines of the margins differ in beyond what the study draws (study::LoopSpread).
namespace zerocount::tuning {

/// The spread of the study's margins without what it draws itself under a condition; none without margins.
/// @param condition 0 without conditions
study::LoopSpread spread_of_undrawn(const study::Study& study, std::int64_t condition);

/// Whether some input whose name fits is drawn under a condition.
template <class Fits>
bool draws(const study::Study& study, std::int64_t condition, const Fits& fits) {
  const study::StudyPlan& plan = *study.plan;
  for (std::size_t column = 0; column < study.columns.inputs.size(); ++column) {
    if (!fits(study.columns.inputs[column].name)) continue;
    const study::Value& value =
        *study::value_at_point(plan, plan.inputs[column].slot, study::plan_point(plan, 0, condition));
    if (!plan.has_conditions() || value.kind != study::Value::Kind::number) return true;
  }
  return false;
}

/// The machine with each combination of the lowest and the highest value of what is spread: 2ⁿ of them, or
/// the machine itself without a spread.
///
///     inertia: J and JL times 1 ± s;  damping: c and cs times 1 ± s;  torque constant: times 1 ± s
std::vector<trial::TrialParameters> corners_of(const trial::TrialParameters& machine,
                                               const study::LoopSpread& spread);

/// The places in corners_of() at which margins usually are smallest: the lowest damping with the highest
/// torque constant, both inertias.
std::vector<std::size_t> likely_worst_corners(const study::LoopSpread& spread);

}  // namespace zerocount::tuning
