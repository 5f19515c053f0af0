#include <cmath>

#include "runners/design_commands/limits_command.hpp"
#include "runners/design_commands/tune/extras.hpp"
#include "runners/design_commands/tune/tune_parts.hpp"
#include "runners/tuning/effects/limits.hpp"

namespace zerocount::design_commands {
namespace {

tuning::ExtraCost cost_of_limits(const tuning::TunedAxis& axis) {
  const std::int64_t points = std::llround(tuning::runs_of_limits(axis.tuned, 0, axis.search.units().count));
  return {.points = points, .trials = points * axis.units().trials()};
}

std::any find_limits(tuning::TunedAxis& axis) {
  const study::Study tuned = axis.on_units();
  return tuning::limits_of(tuning::EffectRuns(tuned, axis.units(), axis.effort));
}

void describe_limits(Items& items) {
  items.include(limits_description("what limits it, each by simulation on the machines of the search"),
                found_by_extra<std::vector<tuning::Limit>>);
}

}  // namespace

tuning::Extra limits_extra() {
  return {.name = "limits",
          .question = "What limits it?",
          .cost = cost_of_limits,
          .run = find_limits,
          .describe = describe_limits};
}

}  // namespace zerocount::design_commands
