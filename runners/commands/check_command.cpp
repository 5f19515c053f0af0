#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/measures/theory_prediction.hpp"
#include "core/loop/controller.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/margins.hpp"
#include "core/theory/sampled_stability.hpp"
#include "core/theory/sliding_loop.hpp"
#include "core/theory/slow_approach.hpp"
#include "core/theory/stability.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/low_end.hpp"
#include "experiments/study/study.hpp"
#include "runners/commands/check_hunting.hpp"
#include "runners/commands/commands.hpp"
#include "runners/plugins/hidden_state.hpp"
#include "runners/plugins/plugin_library.hpp"
#include "runners/study_run/cost.hpp"
#include "runners/study_run/progress.hpp"
#include "runners/study_run/study_size.hpp"

namespace zerocount::commands {
namespace {

constexpr const char* check_help =
    "Reports every error of the manifest with its place. Without errors, prints the plan (design\n"
    "points, trials, cost, size) and the theory of each design point:\n"
    "  - the bounds of ki by the paper's criteria (6) and (7), which ignore sampling, delay and\n"
    "    amplifier, and the bound of the sampled loop at the lowest stiffness k1, which includes\n"
    "    them; both also at the lowest k1 of the study (the low end of its distribution, or the\n"
    "    minimum of the profiles)\n"
    "  - the rules for the DAC and the sample rate\n"
    "  - the slowest time constant of the sampled loop at k1 and k1 + k2, and the time that the\n"
    "    slowest move needs, to compare with the hold\n"
    "  - gain and phase margins of the sampled loop, with all blocks of the controller, at k1, at\n"
    "    k1 + k2 and while the rotor slides\n"
    "  - the bandwidth while it slides: the highest frequency at which the open loop has gain 1\n"
    "\n"
    "Example: zerocount check experiments/manifests/paper-gains.yaml\n";

constexpr std::int64_t max_trials_examined = 200;
constexpr std::int64_t max_trials_examined_closely = 20;
constexpr std::int64_t max_rigs_examined = 10'000;
constexpr std::int64_t points_shown = 20;

/// Range of a quantity over the trials of a point.
struct Range {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
};

std::string text(const Range& range) {
  if (range.low == range.high) return fmt::format("{:.3g}", range.low);
  return fmt::format("{:.3g} … {:.3g}", range.low, range.high);
}

/// Estimated time until a move has arrived, including the dwell.
struct Arrival {
  std::int64_t step{0};  // of the target, counts; 0: no step
  double time{0.0};      // from the start of the move, s
};

/// Margins of a loop over the trials. A trial without a crossover adds nothing.
struct MarginRanges {
  Range gain{};         // dB
  Range gain_at{};      // Hz
  Range phase{};        // degrees
  Range phase_at{};     // Hz
  bool stable{true};    // in every trial
  bool unstable{true};  // in every trial

  void add(const theory::StabilityMargins& margins, bool is_stable) {
    if (!std::isnan(margins.gain.value)) {
      gain.add(20.0 * std::log10(margins.gain.value));
      gain_at.add(margins.gain.frequency);
    }
    if (!std::isnan(margins.phase.value)) {
      phase.add(margins.phase.value);
      phase_at.add(margins.phase.frequency);
    }
    stable = stable && is_stable;
    unstable = unstable && !is_stable;
  }
};

std::string stability_text(const MarginRanges& margins) {
  return margins.stable ? "stable" : (margins.unstable ? "unstable" : "unstable in some trials");
}

std::string margins_text(const MarginRanges& margins) {
  const std::string gain = margins.gain.empty() ? "no phase crossover"
                                                : fmt::format("gain margin {} dB at {} Hz",
                                                              text(margins.gain), text(margins.gain_at));
  const std::string phase = margins.phase.empty() ? "no gain crossover"
                                                  : fmt::format("phase margin {}° at {} Hz",
                                                                text(margins.phase), text(margins.phase_at));
  return gain + ", " + phase;
}

/// One phase of the control while the rotor slides, over the trials.
struct SlidingPhase {
  std::string_view name;
  loop::ControlPhase phase;
  Range bandwidth{};  // Hz
  MarginRanges margins{};
};

/// Results of the theory (section 3 of the paper) for the trials of a design point.
struct PointTheory {
  std::string_view outside;   // reason why the theory does not apply; empty if it does
  std::string_view left_out;  // of the controller, by criteria (6) and (7); empty: they apply
  std::string hunting;        // lines on its prediction; empty: there is none
  bool free{false};           // no spring: ki and sampled_below are of the loop without friction
  Range ki, stable_below, sampled_below, unstable_above;  // gain_unit
  std::string gain_name;                                  // "ki", or that of a cascade
  std::string gain_unit;                                  // its unit in the manifest
  Range dac_resolution, dac_bound;                        // torque_unit
  std::string torque_unit;
  Range frequency, sample_rate;  // Hz
  bool coarse_feedback{false};   // the bound uses the resolution Δx of the coarse encoder
  bool fine_enough{true};        // the DAC satisfies the bound in every trial
  bool fast_enough{true};        // the sample rate satisfies the rule in every trial
  measures::TheoryPrediction prediction;

  study::LowEnd low_end;             // of k1; see lowest_k1, low_stable, low_sampled
  std::int64_t rigs{0};              // number of rigs with profiles; 0 without rigs
  Range lowest_k1;                   // minimum of the profiles, or the low end of the distribution
  Range low_stable, low_sampled;     // bounds at that k1, gain_unit
  Range slowest;                     // slowest time constant of the loop, s
  Arrival longest;                   // slowest move of the trials
  double hold{0.0};                  // of the shortest move, s
  MarginRanges soft, stiff;          // of the loop about k1, and k1 + k2
  std::vector<SlidingPhase> phases;  // phases of the control
};

bool is_cascade(const trial::TrialParameters& p) {
  return p.controller.blocks.structure == loop::ControlStructure::cascade;
}

/// An integral gain (N m/count, of a cascade N m/rad) in the unit of the manifest.
double as_given(const parameters::StudyUnits& units, const trial::TrialParameters& p, double ki) {
  if (units.gains == parameters::GainUnits::count || is_cascade(p)) return ki;
  loop::ControllerParameters controller = p.controller;
  controller.ki = ki;
  return theory::analogue_gains(controller, p.encoder).ki;
}

theory::LinearDrive drive_of(const trial::TrialParameters& p) {
  return {1.0 + p.dac.gain_error, p.amplifier.bandwidth};
}

/// ki below which the trial's sampled loop is stable about a spring of `stiffness` (N m/rad), N m/count.
double sampled_bound(double stiffness, const trial::TrialParameters& p) {
  return theory::sampled_critical_integral_gain(stiffness, p.plant, p.encoder, p.controller, drive_of(p));
}

/// Adds the slowest time constant of the loop in the fine phase about a spring of `stiffness` (N m/rad).
/// Returns false, and adds nothing, if that loop is not stable.
bool add_time_constant(Range& slowest, double stiffness, const trial::TrialParameters& p) {
  const double tau = theory::slowest_time_constant(
      stiffness, p.plant, p.encoder, loop::controller_in_phase(p.controller, loop::ControlPhase::fine),
      drive_of(p));
  if (!std::isfinite(tau) || tau <= 0.0) return false;
  slowest.add(tau);
  return true;
}

double hold_of(const trial::TrialParameters& p) {
  return static_cast<double>(trial::samples_of_move(p, 0)) / p.controller.sample_rate;
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
    theory.sampled_below.add(as_given(study.units, p, sampled_bound(0.0, p)));
    add_time_constant(theory.slowest, 0.0, p);
  }
}

/// Form of the command and friction model are the same in all trials of a point.
std::string_view why_outside(const trial::TrialParameters& first) {
  if (first.controller.user.plugin) return "the controller is a plugin, whose transfer function is not known";
  if (!first.command.torque.levels.empty()) return "the loop is open";
  switch (first.friction.model) {
    case friction::FrictionModel::presliding:
    case friction::FrictionModel::spring:
      return {};
    case friction::FrictionModel::coulomb:
      return "friction.model coulomb has no spring before it slides";
    case friction::FrictionModel::none:
      return "friction.model none has no spring, which criteria (6) and (7) are about";
    case friction::FrictionModel::dahl:
    case friction::FrictionModel::lugre:
    case friction::FrictionModel::gms:
      break;
  }
  return "the spring of this friction.model yields by degrees, from its full stiffness to none, not to k1";
}

void add_sliding(SlidingPhase& phase, const trial::TrialParameters& p) {
  const loop::ControllerParameters controller = loop::controller_in_phase(p.controller, phase.phase);
  const theory::GainCrossover crossover =
      theory::sliding_crossover(p.plant, p.encoder, controller, drive_of(p));
  if (!std::isnan(crossover.frequency)) phase.bandwidth.add(crossover.frequency);
  phase.margins.add(
      theory::margins_about(0.0, p.plant.sliding_damping, p.plant, p.encoder, controller, drive_of(p)),
      theory::stable_while_sliding(p.plant, p.encoder, controller, drive_of(p)));
}

/// Adds the margins of the loop in the fine phase about a spring of `stiffness` (N m/rad).
void add_margins(MarginRanges& margins, double stiffness, const trial::TrialParameters& p) {
  const loop::ControllerParameters controller =
      loop::controller_in_phase(p.controller, loop::ControlPhase::fine);
  margins.add(theory::margins_about(stiffness, p.plant.presliding_damping, p.plant, p.encoder, controller,
                                    drive_of(p)),
              theory::sampled_spectral_radius(stiffness, p.plant, p.encoder, controller, drive_of(p)) < 1.0);
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
  const trial::TrialParameters first = study::study_trial(study, point, 0).parameters;
  theory.hold = hold_of(first);
  if (loop::has_coarse_phase(first.controller)) {
    theory.phases = {{"fine phase", loop::ControlPhase::fine}, {"coarse phase", loop::ControlPhase::coarse}};
  } else {
    theory.phases = {{"loop", loop::ControlPhase::fine}};
  }
  for (std::int64_t index = 0; index < std::min(study.trials, max_trials_examined_closely); ++index) {
    const trial::TrialParameters p = study::study_trial(study, point, index).parameters;
    const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
    const bool stable_at_k1 = add_time_constant(theory.slowest, contact.k1, p);
    const bool stable_at_k2 = add_time_constant(theory.slowest, contact.k1 + contact.k2, p);
    if (stable_at_k1 || stable_at_k2) add_arrivals(theory.longest, p, contact);
    add_margins(theory.soft, contact.k1, p);
    add_margins(theory.stiff, contact.k1 + contact.k2, p);
    const double k1 = theory.low_end.kind == study::LowEnd::Kind::profile ? theory::lowest_k1(p.friction)
                                                                          : theory.low_end.value;
    add_low_end(study, p, k1, theory);
    theory.low_sampled.add(as_given(study.units, p, sampled_bound(k1, p)));
    for (SlidingPhase& phase : theory.phases) add_sliding(phase, p);
  }
  if (theory.low_end.kind == study::LowEnd::Kind::profile) examine_rotors(study, point, theory);
}

PointTheory examine(const study::Study& study, std::int64_t point) {
  PointTheory theory;
  theory.outside = why_outside(study::study_trial(study, point, 0).parameters);
  const trial::TrialParameters first = study::study_trial(study, point, 0).parameters;
  const std::string_view gain = is_cascade(first) ? "controller.cascade.ki" : "controller.ki";
  theory.gain_name = is_cascade(first) ? "cascade.ki" : "ki";
  theory.gain_unit = parameters::unit_of(
      parameters::parameter_table()[parameters::find_parameter(gain).value()], study.units);
  if (!theory.outside.empty()) {
    theory.hunting = hunting_lines(first, drive_of(first));
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
  theory.sampled_below.add(as_given(study.units, softest, sampled_bound(k1.low, softest)));
  theory.sampled_below.add(as_given(study.units, stiffest, sampled_bound(k1.high, stiffest)));
  examine_beyond(study, point, theory);
  return theory;
}

std::string source_of(const PointTheory& theory) {
  switch (theory.low_end.kind) {
    case study::LowEnd::Kind::number:
      return "the one of the manifest";
    case study::LowEnd::Kind::support:
      return "the low end of its distribution";
    case study::LowEnd::Kind::tail:
      return "the 0.1 % quantile of its distribution";
    case study::LowEnd::Kind::profile:
      break;
  }
  if (theory.rigs == 0) return "the lowest along the profiles";
  return fmt::format("the lowest along the profiles of {} rigs", theory.rigs);
}

bool may_be_too_slow(const PointTheory& theory) {
  return theory.slowest.high > theory.hold || theory.longest.time > theory.hold;
}

/// "1 core", "3 cores".
std::string counted(std::int64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// "a move of 30 counts needs about 1 s"; empty where no move is a step.
std::string arrival_text(const Arrival& longest) {
  if (longest.step == 0) return {};
  return fmt::format("a move of {} needs about {:.2g} s", counted(longest.step, "count"), longest.time);
}

/// The line of the slowest time constant; empty if no loop is stable.
std::string slowness_line(const PointTheory& theory) {
  if (theory.slowest.empty()) return {};
  const std::string arrival = arrival_text(theory.longest);
  return fmt::format("    slowest time constant         {} s{}{}, hold {:.4g} s{}\n", text(theory.slowest),
                     arrival.empty() ? "" : "; ", arrival, theory.hold,
                     may_be_too_slow(theory) ? ": moves may end before they arrive" : "");
}

std::string describe_beyond(const PointTheory& theory) {
  const std::string criterion = theory.left_out.empty() ? fmt::format("(6) stable below {:.3g} {}, ",
                                                                      theory.low_stable.low, theory.gain_unit)
                                                        : "";
  std::string out = fmt::format("    at the lowest k1, {} ({}): {}sampled loop below {:.3g} {}\n",
                                text({theory.lowest_k1.low, theory.lowest_k1.low}), source_of(theory),
                                criterion, theory.low_sampled.low, theory.gain_unit);
  out += slowness_line(theory);
  out += fmt::format("    at k1, {}: {}\n", margins_text(theory.soft), stability_text(theory.soft));
  out += fmt::format("    at k1 + k2, {}: {}\n", margins_text(theory.stiff), stability_text(theory.stiff));
  for (const SlidingPhase& phase : theory.phases) {
    const std::string bandwidth =
        phase.bandwidth.empty() ? "" : fmt::format("crosses gain 1 at {} Hz, ", text(phase.bandwidth));
    out += fmt::format("    while sliding, the {}: {}{}: {}\n", phase.name, bandwidth,
                       margins_text(phase.margins), stability_text(phase.margins));
  }
  return out;
}

/// "    (6) stable below              1 … 2 N m/count".
std::string range_line(std::string_view name, const Range& range, std::string_view unit) {
  return fmt::format("    {:<29} {} {}", name, text(range), unit);
}

/// Verdict of the sampled loop on the integral gain.
std::string sampled_verdict(const PointTheory& theory) {
  if (theory.ki.high < theory.sampled_below.low) return "stable";
  return theory.ki.low >= theory.sampled_below.high ? "unstable" : "unstable in some trials";
}

std::string describe_outside(const PointTheory& theory) {
  std::string out = fmt::format("    the criteria do not apply: {}\n", theory.outside);
  if (!theory.free) return out + theory.hunting;
  return out + range_line(theory.gain_name, theory.ki, theory.gain_unit) + ": sampled loop " +
         sampled_verdict(theory) + "\n" +
         range_line("sampled loop, below", theory.sampled_below, theory.gain_unit) + "\n" +
         slowness_line(theory);
}

/// Verdict of the criteria (6) and (7) and of the sampled loop on the integral gain.
std::string gain_verdict(const PointTheory& theory) {
  if (theory.ki.low == 0.0 && theory.ki.high == 0.0)
    return "no integral control: the error stays wherever friction holds the rest of the torque";
  const std::string by_criteria =
      theory.left_out.empty()
          ? fmt::format("by (6) and (7) {}; ", measures::verdict(theory.prediction))
          : fmt::format("(6) and (7) do not apply, since they leave out {}; ", theory.left_out);
  return fmt::format("{}sampled loop at k1 {}", by_criteria, sampled_verdict(theory));
}

std::string describe(const PointTheory& theory) {
  if (!theory.outside.empty()) return describe_outside(theory);
  std::string out;
  const std::string& unit = theory.gain_unit;
  const bool applies = theory.left_out.empty();
  out += range_line(theory.gain_name, theory.ki, unit) + ": " + gain_verdict(theory) + "\n";
  if (applies) out += range_line("(6) stable below", theory.stable_below, unit) + "\n";
  out += range_line("sampled loop at k1, below", theory.sampled_below, unit) + "\n";
  if (applies) out += range_line("(7) unstable above", theory.unstable_above, unit) + "\n";
  out += fmt::format("    DAC: resolution {} {}, must be below k1·Δx = {} {}{}: {}\n",
                     text(theory.dac_resolution), theory.torque_unit, text(theory.dac_bound),
                     theory.torque_unit, theory.coarse_feedback ? " with the Δx of the coarse encoder" : "",
                     theory.fine_enough ? "holds" : "does not hold in every trial");
  out += fmt::format("    natural frequency {} Hz, sample rate {} Hz: {}\n", text(theory.frequency),
                     text(theory.sample_rate),
                     theory.fast_enough ? "ten times that, as advised"
                                        : "in some trials below ten times that, which is advised");
  return out + describe_beyond(theory);
}

/// Prints the input columns that are drawn as often as one of `drawn`, after `title`; nothing if there are
/// none.
void print_columns(const study::Study& study, std::string_view title,
                   std::initializer_list<study::Per> drawn) {
  std::string names;
  for (const study::InputColumn& column : study.input_columns) {
    if (std::find(drawn.begin(), drawn.end(), column.per) != drawn.end()) names += " " + column.name;
  }
  if (!names.empty()) fmt::print("  {}:{}\n", title, names);
}

void print_what_differs(const study::Study& study) {
  if (study.input_columns.empty()) fmt::print("  differing between trials: nothing\n");
  print_columns(study, "differing between trials", {study::Per::trial, study::Per::contact});
  print_columns(study, "of these, drawn anew at each contact", {study::Per::contact});
  print_columns(study, "differing between rigs", {study::Per::rig});
  print_columns(study, "the same in all trials of a point", {study::Per::study});
}

void print_plan(const study::Study& study) {
  const study_run::StudyCost cost = study_run::measure_cost(study);
  fmt::print("{}: {}\n", study.name, study.description.empty() ? "(no description)" : study.description);
  fmt::print("  {} × {} trials = {} trials, {} each\n", counted(study::point_count(study), "design point"),
             study.trials, study::trial_count(study), counted(study.moves, "move"));
  if (study.rigs > 0) {
    fmt::print("  at each point {} rigs × {} trials of each\n", study.rigs, study.trials / study.rigs);
  }
  if (study.stop) {
    fmt::print(
        "  or fewer: after every {} at each point it ends if all success rates are known to ± {:.4g}\n",
        study.stop->block, study.stop->success_rate_halfwidth);
    if (study.rigs > 0) {
      fmt::print(
          "  (of these {} rigs; more trials do not show how other rigs differ; see 'zerocount plan "
          "--rig-sd')\n",
          study.rigs);
    }
  }
  fmt::print("  {:.4g} samples at {:.0f} ns: about {} on {}\n", cost.samples, 1e9 * cost.seconds_per_sample,
             study_run::duration_text(cost.seconds()), counted(cost.cores, "core"));
  const study_run::StudySize size = study_run::measure_size(study);
  fmt::print("  results file about {}; while it runs up to {} on the disk and {} of memory\n",
             study_run::bytes_text(size.file_bytes),
             study_run::bytes_text(size.file_bytes + size.shard_bytes),
             study_run::bytes_text(size.memory_bytes));
  print_what_differs(study);
}

void warn_of_slowness(std::int64_t point, const std::string& label, const PointTheory& theory) {
  const std::string arrival = arrival_text(theory.longest);
  const std::string slow =
      theory.slowest.high > theory.hold
          ? fmt::format(", {:.3g} s, exceeds the hold of {:.4g} s{}{}", theory.slowest.high, theory.hold,
                        arrival.empty() ? "" : "; ", arrival)
          : fmt::format(" is {:.3g} s; {}, longer than the hold of {:.4g} s", theory.slowest.high, arrival,
                        theory.hold);
  fmt::print(stderr,
             "warning: point {} ({}): the loop's slowest time constant{}: moves may end before they arrive\n",
             point, label, slow);
}

ExitCode check(const command_line::Arguments& arguments) {
  const std::string& manifest = arguments.operands()[0];
  const study::Study study =
      manifest::load_study(manifest, arguments.values("set"), plugins::plugins_of(manifest));
  plugins::require_no_hidden_state(study);
  print_warnings(study);
  print_plan(study);
  fmt::print("\nTheory, over the first {} trials of each point, each with the friction it starts on:\n",
             std::min(study.trials, max_trials_examined));
  const std::int64_t shown = arguments.has("all-points") ? study::point_count(study)
                                                         : std::min(study::point_count(study), points_shown);
  for (std::int64_t point = 0; point < shown; ++point) {
    const PointTheory theory = examine(study, point);
    const std::string& label = study.point_labels[static_cast<std::size_t>(point)];
    fmt::print("  point {}: {}\n{}", point, label, describe(theory));
    if (may_be_too_slow(theory)) warn_of_slowness(point, label, theory);
  }
  if (shown < study::point_count(study)) {
    fmt::print("  … and {} more points (--all-points shows them)\n", study::point_count(study) - shown);
  }
  return ExitCode::success;
}

}  // namespace

Command check_command() {
  return {{"check",
           "MANIFEST",
           {{"set", "KEY=VALUE", "override a manifest key; may be repeated", true},
            {"all-points", "", "print the theory of every design point, not only of the first 20"}}},
          "validate a manifest; print its plan and the theory of its points",
          check_help,
          check};
}

}  // namespace zerocount::commands
