#include "analysis/trials/theory/point_theory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "analysis/trials/theory/trial_loops.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/margins.hpp"
#include "core/theory/move_times.hpp"
#include "core/theory/stability.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::theory {
namespace {

constexpr std::int64_t max_machines_examined = 10'000;

bool is_cascade(const trial::TrialParameters& p) {
  return p.controller.blocks.structure == loop::ControlStructure::cascade;
}

/// Whether a disturbance observer brings the error to zero although the control has no integral: it passes on
/// the torque of the control law, which must have a part proportional to the error.
bool acts_by_observer(const loop::ControllerParameters& controller) {
  return controller.blocks.observer.bandwidth > 0.0 && controller.kp > 0.0;
}

/// Converts an integral gain (N m/count; for a cascade N m/rad) to the unit of the manifest.
double as_given(const parameters::StudyUnits& units, const trial::TrialParameters& p, double ki) {
  if (units.gains == parameters::GainUnits::count || is_cascade(p)) return ki;
  loop::ControllerParameters controller = p.controller;
  controller.ki = ki;
  return analogue_gains(controller, p.encoder).ki;
}

/// Linear model of a motor held by a spring of `stiffness` (N m/rad), as before it slides.
friction::LinearContact contact_before_sliding(double stiffness, const trial::TrialParameters& p) {
  return {"", stiffness, p.plant.presliding_damping};
}

/// Integral gain ki below which all sampled loops of the trial are stable, if a spring of `stiffness` (N
/// m/rad) holds the motor, N m/count.
double sampled_bound(double stiffness, const trial::TrialParameters& p) {
  const friction::LinearContact contact = contact_before_sliding(stiffness, p);
  const double scale = static_stiffness(stiffness, p.encoder, p.controller);
  double bound = std::numeric_limits<double>::infinity();
  for (const LoadState& state : load_states(p)) {
    if (!loop_in_state(contact, state, p, p.controller)) continue;
    const auto loop_with = [&](const loop::ControllerParameters& controller) {
      return *loop_in_state(contact, state, p, controller);
    };
    bound = std::min(bound, sampled_critical_integral_gain(loop_with, p.controller, scale));
  }
  return bound;
}

/// Whether friction holds the load in this state. A held load does not approach the target, so the state has
/// no time constant of a move.
bool holds_load(const LoadState& state) {
  return state.friction.stiffness > 0.0 || state.friction.load_stiffness > 0.0;
}

/// Slowest approach without oscillation: time constant −T/ln z of the largest real pole z, s; 0 without such
/// a pole.
double slowest_approach(const Eigen::VectorXcd& poles, double sample_time) {
  constexpr double gone_at_once = 1e-6;  // eigenvalues that are 0 up to rounding
  double slowest = 0.0;
  for (const auto& z : poles) {
    if (z.imag() == 0.0) slowest = std::max(slowest, z.real());
  }
  return slowest > gone_at_once && slowest < 1.0 ? -sample_time / std::log(slowest) : 0.0;
}

/// Adds the slowest time constants of the position loops in the fine phase about a spring of `stiffness` (N
/// m/rad) that bring the masses to the target. Returns false if one of them is not stable, which adds
/// nothing.
bool add_time_constant(Approach& approach, double stiffness, const trial::TrialParameters& p) {
  const auto controller = loop::controller_in_phase(p.controller, loop::ControlPhase::fine);
  bool stable = true;
  for (const LoadState& state : load_states(p)) {
    const auto loop = loop_in_state(contact_before_sliding(stiffness, p), state, p, controller);
    if (!loop || !loop->closes_position || holds_load(state)) continue;
    const Eigen::VectorXcd poles = poles_of(*loop);
    const double tau = slowest_time_constant(poles, loop->sample_time);
    if (std::isfinite(tau) && tau > 0.0) {
      approach.time_constant.add(tau);
      approach.of_moves.add(stiffness > 0.0 ? slowest_approach(poles, loop->sample_time) : tau);
    } else {
      stable = false;
    }
  }
  return stable;
}

double hold_of(const trial::TrialParameters& p) {
  return static_cast<double>(trial::samples_of_move(p, 0)) / p.controller.sample_rate;
}

/// Adds the integral gain below which the trial's sampled loop is stable, if the friction is a spring of
/// `stiffness` (N m/rad), and whether the trial's gain is below it.
void add_sampled_bound(const study::Study& study, const trial::TrialParameters& p, double stiffness,
                       GainTheory& gain) {
  const double bound = sampled_bound(stiffness, p);
  gain.sampled_below.add(as_given(study.units, p, bound));
  gain.sampled_stable.insert(integral_gain(p.controller) < bound);
}

/// The ranges that belong to a loop of a trial. If the loop is new, it is appended to `loops`, because not
/// every trial has a coarse phase.
LoopRanges& ranges_of(std::vector<LoopRanges>& loops, const TrialLoop& of_trial) {
  const auto found = std::ranges::find(loops, of_trial.name, &LoopRanges::name);
  if (found != loops.end()) return *found;
  LoopRanges& added = loops.emplace_back();
  added.name = of_trial.name;
  added.slides = of_trial.slides;
  return added;
}

/// Adds the stability margins of the trial's loops to their ranges, and the bandwidth of loops in which the
/// axis slides.
void add_loops(std::vector<LoopRanges>& loops, const trial::TrialParameters& p) {
  for (const TrialLoop& of_trial : trial_loops(p)) {
    LoopRanges& ranges = ranges_of(loops, of_trial);
    const StabilityMargins margins = stability_margins(of_trial.loop);
    if (margins.no_gain_stabilises) ranges.no_gain_stabilises = true;
    ranges.gain.add(20.0 * std::log10(margins.gain.value));
    ranges.gain_at.add(margins.gain.frequency);
    ranges.phase.add(margins.phase.value);
    ranges.phase_at.add(margins.phase.frequency);
    const Eigen::VectorXcd poles = poles_of(of_trial.loop);
    ranges.stability.insert(stability_of(poles, of_trial.loop.sample_time, p.command.hold));
    const double slowest = slowest_time_constant(poles, of_trial.loop.sample_time);
    if (slowest > p.command.hold && std::isfinite(slowest)) ranges.slow.add(slowest);
    if (of_trial.slides) ranges.bandwidth.add(margins.crossover.frequency);
  }
}

/// Adds the theory of a trial whose loop has no spring: its sampled bound and time constant.
void examine_free(const study::Study& study, const trial::TrialParameters& p, PointTheory& theory) {
  theory.gain.value.add(as_given(study.units, p, integral_gain(p.controller)));
  add_sampled_bound(study, p, 0.0, theory.gain);
  add_time_constant(theory.approach, 0.0, p);
}

/// The initial errors of moves (step sizes) in the fine phase, counts; empty unless the reference is a step.
std::set<std::int64_t> steps_of(const trial::TrialParameters& p) {
  std::set<std::int64_t> steps;
  if (p.command.profile.shape != loop::ReferenceShape::step) return steps;
  const auto largest = loop::has_coarse_phase(p.controller)
                           ? static_cast<std::int64_t>(p.controller.coarse.fine_within)
                           : std::numeric_limits<std::int64_t>::max();
  for (const TargetStep& step : target_steps(p.command)) steps.insert(std::min(step.length(), largest));
  steps.erase(0);
  return steps;
}

/// Updates the slowest move and its arrival time, for slow integral control by the PID law.
void add_arrivals(Approach& approach, const trial::TrialParameters& p,
                  const friction::FrictionParameters& contact) {
  if (!(p.controller.ki > 0.0) || is_cascade(p)) return;
  const double judged = chatter_time(p.plant, contact, p.controller, p.verdict.dwell) +
                        std::max(p.verdict.dwell, p.verdict.window);
  for (const std::int64_t step : steps_of(p)) {
    const double time = slow_arrival_time(step, contact, p.encoder, p.controller) + judged;
    if (time <= approach.longest_time) continue;
    approach.longest_step = step;
    approach.longest_time = time;
  }
}

/// Whether criteria (6) and (7) of the paper apply to the loop of this trial.
bool criteria_apply(const trial::TrialParameters& p) {
  return left_out_of_criteria(p.plant, p.controller).empty();
}

/// The lowest stiffness k1 along a trial's rotor, and the bound of criterion (6) for it.
struct LowEnd {
  double k1;  ///< Lowest k1, N m/rad.
  /// Bound of criterion (6) on the integral gain, in the unit of the manifest. Empty if the criterion does
  /// not apply.
  std::optional<double> stable_below;
};

LowEnd low_end_at(const study::Study& study, const trial::TrialParameters& p, double k1) {
  if (!criteria_apply(p)) return {k1, {}};
  return {k1, as_given(study.units, p, critical_integral_gain(k1, p.plant, p.encoder, p.controller))};
}

void add(LowestStiffness& lowest, const LowEnd& end) {
  lowest.k1.add(end.k1);
  if (end.stable_below) lowest.stable_below.add(*end.stable_below);
}

/// A design point in one setting (condition at an age), whose trials are examined.
struct ExaminedPoint {
  const study::Study& study;
  std::int64_t point;
  std::int64_t setting;

  /// Parameters of the trial of this point and setting with the draw number `draw` (TrialIndices).
  trial::TrialParameters trial(std::int64_t draw) const {
    return study::study_trial(study, point, study::trial_indices(study).trial_of(draw, setting)).parameters;
  }
};

/// Sets lowest_k1() of a rotor whose k1 varies along it, unless it is known from the design point before.
void know_rotor(const friction::FrictionAlongRotor& friction, KnownRotor& known) {
  const auto k1 = std::ranges::find(friction.profiled, &friction::FrictionParameters::k1,
                                    &friction::ProfiledParameter::parameter);
  if (known.k1 != k1->profile) known = {k1->profile, lowest_k1(friction)};
}

/// Examines the lowest k1 of the rotors of all machines (draw j belongs to machine j mod machines). The bound
/// of the sampled loop, which takes longer, is computed only at the lowest of them.
void examine_rotors(const ExaminedPoint& at, LowestStiffness& lowest, std::vector<KnownRotor>& known) {
  const study::Study& study = at.study;
  lowest.machines = std::min(study.machines, max_machines_examined);
  if (lowest.machines == 0) return;
  const auto machines = static_cast<std::size_t>(lowest.machines);
  known.resize(machines);
  std::vector<LowEnd> ends(machines);
  constexpr std::size_t machines_at_once = 8;
  parallel::for_each_index((machines + machines_at_once - 1) / machines_at_once, [&](std::size_t block) {
    for (std::size_t machine = block * machines_at_once;
         machine < std::min((block + 1) * machines_at_once, machines); ++machine) {
      const trial::TrialParameters p = at.trial(static_cast<std::int64_t>(machine));
      know_rotor(p.friction, known[machine]);
      ends[machine] = low_end_at(study, p, known[machine].lowest);
    }
  });
  for (const LowEnd& end : ends) add(lowest, end);
  const auto softest = std::ranges::min_element(ends, {}, &LowEnd::k1);
  const trial::TrialParameters p = at.trial(softest - ends.begin());
  lowest.sampled_below.add(as_given(study.units, p, sampled_bound(softest->k1, p)));
}

/// Adds results that take longer to compute and are not in the paper: the sampled loop, its time constants
/// and margins, and the loop at the lowest k1.
void examine_closely(const study::Study& study, const trial::TrialParameters& p, PointTheory& theory) {
  const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
  add_sampled_bound(study, p, contact.k1, theory.gain);
  const bool stable_at_k1 = add_time_constant(theory.approach, contact.k1, p);
  const bool stable_at_k2 = add_time_constant(theory.approach, contact.k1 + contact.k2, p);
  if (stable_at_k1 || stable_at_k2) add_arrivals(theory.approach, p, contact);
  add_loops(theory.loops, p);
  LowestStiffness& lowest = theory.lowest;
  const bool varies = lowest.source.kind == study::LowEnd::Kind::profile;
  const double k1 = varies ? lowest_k1(p.friction) : lowest.source.value;
  add(lowest, low_end_at(study, p, k1));
  lowest.sampled_below.add(as_given(study.units, p, sampled_bound(k1, p)));
}

/// Adds the results of criteria (6) and (7) and of the paper's design rules for one trial.
void add_criteria(const study::Study& study, const trial::TrialParameters& p,
                  const friction::FrictionParameters& contact, GainTheory& gain, DesignRules& rules) {
  const TrialPrediction prediction = predict(p);
  const IntegralGainBounds bounds = integral_gain_bounds(p.plant, contact, p.encoder, p.controller);
  const double dac_bound = dac_resolution_bound(contact.k1, p.encoder, p.controller.encoder);
  gain.value.add(as_given(study.units, p, integral_gain(p.controller)));
  gain.observes = gain.observes || acts_by_observer(p.controller);
  if (gain.left_out.empty()) gain.left_out = left_out_of_criteria(p.plant, p.controller);
  if (criteria_apply(p)) {
    gain.stable_below.add(as_given(study.units, p, bounds.stable_below));
    gain.unstable_above.add(as_given(study.units, p, bounds.unstable_above));
  }
  gain.prediction.add(prediction);
  rules.coarse_feedback = p.controller.encoder == loop::EncoderChoice::coarse;
  rules.dac_resolution.add(p.dac.resolution);
  rules.dac_bound.add(dac_bound);
  ++rules.trials;
  if (p.dac.resolution < dac_bound) ++rules.fine_enough;
  rules.frequency.add(natural_frequency(contact.k1 + contact.k2, p.plant));
  rules.sample_rate.add(p.controller.sample_rate);
  if (p.controller.sample_rate >= advised_sample_rate(p.plant, contact)) ++rules.fast_enough;
}

/// Calls `add` with the parameters of each of the first `count` trials of the design point and setting.
template <typename Add>
void for_trials(const ExaminedPoint& at, std::int64_t count, Add add) {
  for (std::int64_t draw = 0; draw < std::min(study::draw_count(at.study), count); ++draw)
    add(at.trial(draw));
}

void examine_outside(const ExaminedPoint& at, const trial::TrialParameters& first, PointTheory& theory) {
  const study::Study& study = at.study;
  theory.free = !has_no_linear_loop(first) && !friction::has_friction(first.friction.model);
  for_trials(at, max_trials_examined_closely, [&](const trial::TrialParameters& p) {
    add_loops(theory.loops, p);
    if (theory.free) examine_free(study, p, theory);
  });
}

void examine_springs(const ExaminedPoint& at, std::vector<KnownRotor>& known, PointTheory& theory) {
  const study::Study& study = at.study;
  theory.rules.torque_unit = parameters::unit_on(study.units.axis, "N m");
  theory.lowest.source = study::low_end(study, at.point, parameter::friction::k1, at.setting);
  trial::TrialParameters softest;
  trial::TrialParameters stiffest;
  Range k1;  // N m/rad
  for_trials(at, max_trials_examined, [&](const trial::TrialParameters& p) {
    const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
    add_criteria(study, p, contact, theory.gain, theory.rules);
    if (contact.k1 < k1.low) softest = p;
    if (contact.k1 > k1.high) stiffest = p;
    k1.add(contact.k1);
  });
  // If k1 is the only difference between the trials, these two have the extreme bounds.
  add_sampled_bound(study, softest, k1.low, theory.gain);
  add_sampled_bound(study, stiffest, k1.high, theory.gain);
  add_loops(theory.loops, softest);
  add_loops(theory.loops, stiffest);
  for_trials(at, max_trials_examined_closely,
             [&](const trial::TrialParameters& p) { examine_closely(study, p, theory); });
  if (theory.lowest.source.kind == study::LowEnd::Kind::profile) examine_rotors(at, theory.lowest, known);
}

}  // namespace

PointTheory examine(const study::Study& study, std::int64_t point, std::int64_t setting,
                    std::vector<KnownRotor>& rotors) {
  PointTheory theory;
  const ExaminedPoint at{study, point, setting};
  const trial::TrialParameters first = at.trial(0);
  const std::string_view gain =
      is_cascade(first) ? parameter::controller::cascade::ki : parameter::controller::ki;
  theory.gain.name = gain.substr(gain.find('.') + 1);
  theory.gain.unit = parameters::unit_of(
      parameters::parameter_table()[parameters::find_parameter(gain).value()], study.units);
  theory.approach.hold = hold_of(first);
  theory.outside = why_outside_theory(first);
  theory.cut = states_without_loop(first);
  if (theory.outside.empty()) {
    examine_springs(at, rotors, theory);
  } else {
    examine_outside(at, first, theory);
  }
  return theory;
}

}  // namespace zerocount::theory
