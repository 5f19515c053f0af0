#include "experiments/study/loop_extras.hpp"

#include <algorithm>
#include <array>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/point_limits.hpp"

namespace zerocount::study {
namespace {

using Limits = std::span<const ValueLimits>;

bool holds_for_one(const StudyPlan& plan, std::string_view name, bool (*holds)(const ValueLimits&)) {
  return holds_somewhere(plan, {&name, 1}, [holds](Limits l) { return holds(l[0]); });
}

bool has_encoder_errors(const StudyPlan& plan) {
  constexpr std::array<std::string_view, 8> amplitudes{
      "encoder.fine_errors.eccentricity",   "encoder.fine_errors.interpolation",
      "encoder.fine_errors.noise",          "encoder.fine_errors.missed",
      "encoder.coarse_errors.eccentricity", "encoder.coarse_errors.interpolation",
      "encoder.coarse_errors.noise",        "encoder.coarse_errors.missed"};
  return std::any_of(amplitudes.begin(), amplitudes.end(), [&](std::string_view amplitude) {
    return holds_for_one(plan, amplitude, [](const ValueLimits& l) { return l.high > 0.0; });
  });
}

// Whether the friction causes hunting with integral control.
bool causes_hunting(friction::FrictionModel model) {
  switch (model) {
    case friction::FrictionModel::coulomb:
      return true;
    case friction::FrictionModel::presliding:
    case friction::FrictionModel::spring:
    case friction::FrictionModel::none:
      break;
  }
  return false;
}

bool has_lasting_errors(const StudyPlan& plan) {
  return holds_for_one(plan, "controller.ki", [](const ValueLimits& l) { return l.can_be_zero; }) ||
         holds_for_one(plan, "friction.model", [](const ValueLimits& l) {
           return causes_hunting(static_cast<friction::FrictionModel>(static_cast<int>(l.low)));
         });
}

}  // namespace

LoopExtras find_loop_extras(const StudyPlan& plan) {
  return {has_encoder_errors(plan), has_lasting_errors(plan)};
}

}  // namespace zerocount::study
