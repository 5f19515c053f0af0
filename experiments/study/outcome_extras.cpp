#include "experiments/study/outcome_extras.hpp"

#include <array>

#include "experiments/study/point_limits.hpp"

namespace zerocount::study {

OutcomeExtras find_outcome_extras(const StudyPlan& plan) {
  const std::array<std::string_view, 1> stop{"verdict.stop"};
  const auto is_true = [](std::span<const ValueLimits> limits) { return limits[0].high > 0.0; };
  return {!plan.open_loop && holds_somewhere(plan, stop, is_true)};
}

}  // namespace zerocount::study
