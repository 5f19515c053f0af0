#include "experiments/study/trace_extras.hpp"

#include <array>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/point_limits.hpp"

namespace zerocount::study {
namespace {

using Limits = std::span<const ValueLimits>;
using Names = std::initializer_list<std::string_view>;

bool has_profile(const StudyPlan& plan) {
  const std::array<std::string_view, 1> shape{"command.profile.shape"};
  return !plan.open_loop && holds_somewhere(plan, shape, [](Limits l) {
    return l[0].high > static_cast<double>(loop::ReferenceShape::step);
  });
}

bool has_two_phases(const StudyPlan& plan) {
  const std::array<std::string_view, 1> coarse_beyond{"controller.coarse.coarse_beyond"};
  return !plan.open_loop &&
         holds_somewhere(plan, coarse_beyond, [](Limits l) { return can_have_coarse_phase(l[0]); });
}

bool has_uneven_drive(const StudyPlan& plan) {
  for (const std::string_view name :
       Names{"dac.offset", "dac.gain_error", "dac.nonlinearity", "dac.noise", "amplifier.bandwidth"}) {
    const std::array<std::string_view, 1> error{name};
    if (holds_somewhere(plan, error, [](Limits l) { return l[0].low != 0.0 || l[0].high != 0.0; }))
      return true;
  }
  if (!plan.open_loop) return false;
  const std::array<std::string_view, 2> command{"command.torque.through", "controller.delay"};
  return holds_somewhere(plan, command, [](Limits l) {
    return l[0].high == static_cast<double>(trial::TorquePath::exact) || l[1].high > 0.0;
  });
}

}  // namespace

TraceExtras find_trace_extras(const StudyPlan& plan) {
  return {has_profile(plan), has_two_phases(plan), has_uneven_drive(plan)};
}

}  // namespace zerocount::study
