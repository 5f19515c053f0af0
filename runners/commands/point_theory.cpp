#include "runners/commands/point_theory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "analysis/measures/trial_loops.hpp"
#include "core/loop/controller.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/sampled_stability.hpp"
#include "core/theory/sliding_loop.hpp"
#include "core/theory/slow_approach.hpp"
#include "core/theory/stability.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "runners/commands/check_hunting.hpp"

namespace zerocount::commands {
namespace {

constexpr std::int64_t max_rigs_examined = 10'000;

bool is_cascade(const trial::TrialParameters& p) {
  return p.controller.blocks.structure == loop::ControlStructure::cascade;
}

/// Whether an observer brings the error to zero where the control has no integral: it passes on the torque of
/// the control law, which must have a part proportional to the error.
bool acts_by_observer(const loop::ControllerParameters& controller) {
  return controller.blocks.observer.bandwidth > 0.0 && controller.kp > 0.0;
}

/// An integral gain (N m/count, of a cascade N m/rad) in the unit of the manifest.
double as_given(const parameters::StudyUnits& units, const trial::TrialParameters& p, double ki) {
  if (units.gains == parameters::GainUnits::count || is_cascade(p)) return ki;
  loop::ControllerParameters controller = p.controller;
  controller.ki = ki;
  return theory::analogue_gains(controller, p.encoder).ki;
}

/// ki below which the trial's sampled loop is stable about a spring of `stiffness` (N m/rad), N m/count.
double sampled_bound(double stiffness, const trial::TrialParameters& p) {
  return theory::sampled_critical_integral_gain(stiffness, p.plant, p.encoder, p.controller,
                                                measures::drive_of(p));
}

/// Adds the slowest time constant of the loop in the fine phase about a spring of `stiffness` (N m/rad).
/// Returns false, and adds nothing, if that loop is not stable.
bool add_time_constant(Range& slowest, double stiffness, const trial::TrialParameters& p) {
  const double tau = theory::slowest_time_constant(
      stiffness, p.plant, p.encoder, loop::controller_in_phase(p.controller, loop::ControlPhase::fine),
      measures::drive_of(p));
  if (!std::isfinite(tau) || tau <= 0.0) return false;
  slowest.add(tau);
  return true;
}

double hold_of(const trial::TrialParameters& p) {
  return static_cast<double>(trial::samples_of_move(p, 0)) / p.controller.sample_rate;
}

/// Adds the bound of the trial's sampled loop about a spring of `stiffness` (N m/rad).
void add_sampled_bound(const study::Study& study, const trial::TrialParameters& p, double stiffness,
                       PointTheory& theory) {
  const double bound = sampled_bound(stiffness, p);
  theory.sampled_below.add(as_given(study.units, p, bound));
  theory.sampled_stable.insert(theory::integral_gain(p.controller) < bound);
}

/// The theory of a loop without a spring: its sampled bound and time constant.
void examine_free(const study::Study& study, std::int64_t point, PointTheory& theory) {
  const trial::TrialParameters first = study::study_trial(study, point, 0).parameters;
  theory.free = !first.controller.user.plugin && first.friction.model == friction::FrictionModel::none &&
                first.command.torque.levels.empty();
  if (!theory.free) return;
  theory.hold = hold_of(first);
  for (std::int64_t index = 0; index < std::min(study.trials, max_trials_examined_closely); ++index) {
    const trial::TrialParameters p = study::study_trial(study, point, index).parameters;
    theory.ki.add(as_given(study.units, p, theory::integral_gain(p.controller)));
    add_sampled_bound(study, p, 0.0, theory);
    add_time_constant(theory.slowest, 0.0, p);
  }
}

/// The ranges of this loop, at the end of `loops` if it is new: not every trial has a coarse phase.
LoopRanges& ranges_of(std::vector<LoopRanges>& loops, const measures::TrialLoop& of_trial) {
  auto found = std::find_if(loops.begin(), loops.end(),
                            [&](const LoopRanges& loop) { return loop.name == of_trial.name; });
  if (found == loops.end())
    found = loops.insert(loops.end(), {.name = of_trial.name, .slides = of_trial.slides});
  return *found;
}

/// Adds the margins of the trial's loops, and the bandwidth of those that slide.
void add_loops(std::vector<LoopRanges>& loops, const trial::TrialParameters& p) {
  for (const measures::TrialLoop& of_trial : measures::trial_loops(p)) {
    LoopRanges& loop = ranges_of(loops, of_trial);
    loop.margins.add(theory::stability_margins(of_trial.loop), theory::stability_of(of_trial.loop));
    if (!of_trial.slides) continue;
    const theory::GainCrossover crossover = theory::gain_crossover(of_trial.loop);
    if (!std::isnan(crossover.frequency)) loop.bandwidth.add(crossover.frequency);
  }
}

/// The initial errors of moves in the fine phase, counts; empty unless the reference is a step.
std::set<std::int64_t> steps_of(const trial::TrialParameters& p) {
  std::set<std::int64_t> steps;
  if (p.command.profile.shape != loop::ReferenceShape::step) return steps;
  const auto largest = loop::has_coarse_phase(p.controller)
                           ? static_cast<std::int64_t>(p.controller.coarse.fine_within)
                           : std::numeric_limits<std::int64_t>::max();
  std::int64_t before = 0;
  for (const std::int64_t target : p.command.targets) {
    steps.insert(std::min(std::abs(target - before), largest));
    before = target;
  }
  steps.erase(0);
  return steps;
}

/// Updates the slowest move, for slow integral control by the PID law.
void add_arrivals(Arrival& longest, const trial::TrialParameters& p,
                  const friction::FrictionParameters& contact) {
  if (!(p.controller.ki > 0.0) || is_cascade(p)) return;
  const double judged = theory::chatter_time(p.plant, contact, p.controller, p.verdict.dwell) +
                        std::max(p.verdict.dwell, p.verdict.window);
  for (const std::int64_t step : steps_of(p)) {
    const double time = theory::slow_arrival_time(step, contact, p.encoder, p.controller) + judged;
    if (time > longest.time) longest = {step, time};
  }
}

/// Adds criterion (6) for this k1.
void add_low_end(const study::Study& study, const trial::TrialParameters& p, double k1, PointTheory& theory) {
  friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
  contact.k1 = k1;
  theory.lowest_k1.add(k1);
  const theory::IntegralGainBounds bounds =
      theory::integral_gain_bounds(p.plant, contact, p.encoder, p.controller);
  theory.low_stable.add(as_given(study.units, p, bounds.stable_below));
}

/// Examines the lowest k1 of the rotors of all rigs (trial i runs on rig i mod rigs). The bound of the
/// sampled loop, which takes longer, is computed only at the lowest of them.
void examine_rotors(const study::Study& study, std::int64_t point, PointTheory& theory) {
  theory.rigs = std::min(study.rigs, max_rigs_examined);
  trial::TrialParameters softest;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::int64_t rig = 0; rig < theory.rigs; ++rig) {
    const trial::TrialParameters p = study::study_trial(study, point, rig).parameters;
    const double k1 = theory::lowest_k1(p.friction);
    add_low_end(study, p, k1, theory);
    if (k1 >= lowest) continue;
    lowest = k1;
    softest = p;
  }
  if (theory.rigs > 0) theory.low_sampled.add(as_given(study.units, softest, sampled_bound(lowest, softest)));
}

/// Examines properties that the paper does not treat: the sampled loop at the lowest k1, its time constants,
/// and the loop while the rotor slides.
void examine_beyond(const study::Study& study, std::int64_t point, PointTheory& theory) {
  theory.low_end = study::low_end(study, point, "friction.k1");
  theory.hold = hold_of(study::study_trial(study, point, 0).parameters);
  for (std::int64_t index = 0; index < std::min(study.trials, max_trials_examined_closely); ++index) {
    const trial::TrialParameters p = study::study_trial(study, point, index).parameters;
    const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
    add_sampled_bound(study, p, contact.k1, theory);
    const bool stable_at_k1 = add_time_constant(theory.slowest, contact.k1, p);
    const bool stable_at_k2 = add_time_constant(theory.slowest, contact.k1 + contact.k2, p);
    if (stable_at_k1 || stable_at_k2) add_arrivals(theory.longest, p, contact);
    add_loops(theory.loops, p);
    const double k1 = theory.low_end.kind == study::LowEnd::Kind::profile ? theory::lowest_k1(p.friction)
                                                                          : theory.low_end.value;
    add_low_end(study, p, k1, theory);
    theory.low_sampled.add(as_given(study.units, p, sampled_bound(k1, p)));
  }
  if (theory.low_end.kind == study::LowEnd::Kind::profile) examine_rotors(study, point, theory);
}

}  // namespace

PointTheory examine(const study::Study& study, std::int64_t point) {
  PointTheory theory;
  const trial::TrialParameters first = study::study_trial(study, point, 0).parameters;
  theory.outside = measures::why_outside_theory(first);
  const std::string_view gain = is_cascade(first) ? "controller.cascade.ki" : "controller.ki";
  theory.gain_name = is_cascade(first) ? "cascade.ki" : "ki";
  theory.gain_unit = parameters::unit_of(
      parameters::parameter_table()[parameters::find_parameter(gain).value()], study.units);
  if (!theory.outside.empty()) {
    theory.hunting = hunting_lines(first, measures::drive_of(first));
    for (std::int64_t index = 0; index < std::min(study.trials, max_trials_examined_closely); ++index)
      add_loops(theory.loops, study::study_trial(study, point, index).parameters);
    examine_free(study, point, theory);
    return theory;
  }
  theory.torque_unit = parameters::unit_on(study.units.axis, "N m");
  trial::TrialParameters softest;
  trial::TrialParameters stiffest;
  Range k1;  // N m/rad
  for (std::int64_t index = 0; index < std::min(study.trials, max_trials_examined); ++index) {
    const trial::TrialParameters p = study::study_trial(study, point, index).parameters;
    const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
    const theory::IntegralGainBounds bounds =
        theory::integral_gain_bounds(p.plant, contact, p.encoder, p.controller);
    const double dac_bound = theory::dac_resolution_bound(contact.k1, p.encoder, p.controller.encoder);
    theory.coarse_feedback = p.controller.encoder == loop::EncoderChoice::coarse;
    theory.ki.add(as_given(study.units, p, theory::integral_gain(p.controller)));
    theory.observes = theory.observes || acts_by_observer(p.controller);
    if (theory.left_out.empty()) theory.left_out = theory::left_out_of_criteria(p.plant, p.controller);
    theory.stable_below.add(as_given(study.units, p, bounds.stable_below));
    theory.unstable_above.add(as_given(study.units, p, bounds.unstable_above));
    theory.dac_resolution.add(p.dac.resolution);
    theory.dac_bound.add(dac_bound);
    theory.frequency.add(theory::natural_frequency(contact.k1 + contact.k2, p.plant));
    theory.sample_rate.add(p.controller.sample_rate);
    theory.fine_enough = theory.fine_enough && p.dac.resolution < dac_bound;
    theory.fast_enough =
        theory.fast_enough && p.controller.sample_rate >= theory::advised_sample_rate(p.plant, contact);
    theory.prediction.add(measures::predict(p));
    if (contact.k1 < k1.low) softest = p;
    if (contact.k1 > k1.high) stiffest = p;
    k1.add(contact.k1);
  }
  // Where k1 alone differs these two have the extreme bounds; those of other parameters show in the closer
  // look.
  add_sampled_bound(study, softest, k1.low, theory);
  add_sampled_bound(study, stiffest, k1.high, theory);
  add_loops(theory.loops, softest);
  add_loops(theory.loops, stiffest);
  examine_beyond(study, point, theory);
  return theory;
}

}  // namespace zerocount::commands
