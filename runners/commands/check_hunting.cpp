#include "runners/commands/check_hunting.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/measures/trial_loops.hpp"
#include "core/loop/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/describing_function.hpp"
#include "core/theory/frozen_loop.hpp"
#include "core/theory/hunting.hpp"

namespace zerocount::commands {
namespace {

std::string line(std::string_view by, const theory::LimitCycle& cycle, double resolution) {
  return fmt::format("    hunting of trial 0, {}: amplitude {:.4g} counts, period {:.4g} s\n", by,
                     cycle.amplitude / resolution, cycle.period);
}

/// In the fine phase, which comes first of the loops that slide.
bool is_stable_while_sliding(const trial::TrialParameters& trial) {
  const std::vector<measures::TrialLoop> loops = measures::trial_loops(trial);
  const auto sliding = std::ranges::find_if(loops, &measures::TrialLoop::slides);
  return sliding != loops.end() && theory::stability_of(sliding->loop) == theory::LoopStability::stable;
}

}  // namespace

std::string hunting_lines(const trial::TrialParameters& trial, const theory::LinearDrive& drive) {
  const friction::FrictionModel model = trial.friction.model;
  const bool closed_loop = trial.command.torque.levels.empty();
  if (!closed_loop || trial.controller.user.plugin || !theory::has_describing_function(model)) return {};
  const loop::ControllerParameters controller =
      loop::controller_in_phase(trial.controller, loop::ControlPhase::fine);
  const std::string_view left_out = theory::left_out_of_hunting(trial.plant, controller);
  if (!left_out.empty())
    return fmt::format("    hunting of trial 0: not predicted, since the predictions leave out {}\n",
                       left_out);
  const std::string_view beyond =
      !is_stable_while_sliding(trial)
          ? "; the loop is unstable while the rotor slides: what has broken loose may grow"
          : "";
  const friction::FrictionParameters contact = friction::friction_at(trial.friction, trial.initial.position);
  const double resolution = loop::fine_resolution(trial.encoder);
  constexpr std::string_view by_function = "by describing function";
  std::string lines;
  for (const theory::LimitCycle& cycle :
       theory::harmonic_balance(model, contact, trial.plant, trial.encoder, controller, drive)) {
    lines += line(by_function, cycle, resolution);
  }
  if (lines.empty())
    lines = fmt::format("    hunting of trial 0, {}: no lasting cycle{}\n", by_function, beyond);
  if (model != friction::FrictionModel::coulomb) return lines;
  const auto cycle = theory::stick_slip_cycle(contact, trial.plant, trial.encoder, controller);
  constexpr std::string_view by_slides = "by stick-slip";
  return lines + (cycle ? line(by_slides, *cycle, resolution)
                        : fmt::format("    hunting of trial 0, {}: no lasting cycle{}\n", by_slides, beyond));
}

}  // namespace zerocount::commands
