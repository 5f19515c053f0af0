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
#include "core/theory/sampled_stability.hpp"
#include "core/theory/sliding_loop.hpp"
#include "core/theory/slow_approach.hpp"
#include "core/theory/stability.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/low_end.hpp"
#include "experiments/study/study.hpp"
#include "runners/commands/commands.hpp"
#include "runners/commands/warnings.hpp"
#include "runners/study_run/cost.hpp"
#include "runners/study_run/progress.hpp"
#include "runners/study_run/study_size.hpp"

namespace zerocount {
namespace {

constexpr const char* check_help =
    "Reports every error of the manifest, each with its place. If there is none, prints the\n"
    "plan (design points, trials, cost, size) and what the theory says of each design point: the\n"
    "bounds of the paper's criteria (6) and (7) on ki, which know of no sampling, delay or\n"
    "amplifier, the bound of the sampled loop about the lowest stiffness k1, which has them,\n"
    "and the rules for the DAC and the sample rate. Both bounds are also given at the lowest k1\n"
    "of the study: the low end of its distribution, or the lowest along the profiles. The\n"
    "slowest time constant with which the sampled loop approaches its target, at k1 and k1 + k2,\n"
    "and the time that the slowest of the moves needs stand beside the hold. While the rotor slides, the "
    "bandwidth is the highest frequency at\n"
    "which the open loop has gain 1.\n"
    "\n"
    "Example: zerocount check experiments/manifests/paper-gains.yaml\n";

constexpr std::int64_t max_trials_examined = 200;
constexpr std::int64_t max_trials_examined_closely = 20;
constexpr std::int64_t max_rigs_examined = 10'000;
constexpr std::int64_t points_shown = 20;

/// A quantity over the trials of a point.
struct Range {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

std::string text(const Range& range) {
  if (range.low == range.high) return fmt::format("{:.3g}", range.low);
  return fmt::format("{:.3g} … {:.3g}", range.low, range.high);
}

/// When a move has arrived, and that was seen.
struct Arrival {
  std::int64_t step{0};  // of the target, counts; 0: there is none
  double time{0.0};      // from its start, s
};

/// One phase of the control while the rotor slides, over the trials.
struct SlidingPhase {
  std::string_view name;
  Range bandwidth;      // Hz
  Range phase_margin;   // degrees
  bool stable{true};    // in every trial
  bool unstable{true};  // in every trial
};

/// What section 3 of the paper says of the trials of a design point.
struct PointTheory {
  std::string_view outside;  // why it says nothing of them; empty where it does
  bool free{false};          // outside, and the rotor has no spring: the next two are of the loop without one
  Range ki, stable_below, sampled_below, unstable_above;  // gain_unit; sampled_below of softest and stiffest
  std::string gain_unit;                                  // that of controller.ki in the manifest
  Range dac_resolution, dac_bound;                        // torque_unit
  std::string torque_unit;
  Range frequency, sample_rate;  // Hz
  bool coarse_feedback{false};   // Δx of that bound is the coarse encoder's
  bool fine_enough{true};        // the DAC, in every trial
  bool fast_enough{true};        // the sampling, in every trial
  TheoryPrediction prediction;

  LowEnd low_end;                    // of k1, for which the next two are
  std::int64_t rigs{0};              // whose profiles were examined; 0 without rigs
  Range lowest_k1;                   // of the profiles, or the low end
  Range low_stable, low_sampled;     // bounds there, gain_unit
  Range slowest;                     // time constant of the approach, s
  Arrival longest;                   // of the moves, in the trials
  double hold{0.0};                  // of the shortest move, s
  std::vector<SlidingPhase> phases;  // of the control
};

/// A gain of the trapezoidal rule (N m/count) in the unit of the manifest.
double as_given(const StudyUnits& units, const TrialParameters& p, double ki) {
  switch (units.gains) {
    case GainUnits::count:
      break;
    case GainUnits::si: {
      ControllerParameters controller = p.controller;
      controller.ki = ki;
      return analogue_gains(controller, p.encoder).ki;
    }
  }
  return ki;
}

LinearDrive drive_of(const TrialParameters& p) {
  return {1.0 + p.dac.gain_error, p.amplifier.bandwidth};
}

/// ki below which the trial's sampled loop is stable about a spring of `stiffness` (N m/rad), N m/count.
double sampled_bound(double stiffness, const TrialParameters& p) {
  return sampled_critical_integral_gain(stiffness, p.plant, p.encoder, p.controller, drive_of(p));
}

/// What remains to be said of a loop without a spring: its sampled bound and time constant.
void examine_free(const Study& study, std::int64_t point, PointTheory& theory) {
  const TrialParameters first = study_trial(study, point, 0).parameters;
  theory.free = first.friction.model == FrictionModel::none && first.command.torque.levels.empty();
  if (!theory.free) return;
  theory.hold = static_cast<double>(samples_of_move(first, 0)) / first.controller.sample_rate;
  for (std::int64_t index = 0; index < std::min(study.trials, max_trials_examined_closely); ++index) {
    const TrialParameters p = study_trial(study, point, index).parameters;
    const ControllerParameters fine = controller_in_phase(p.controller, ControlPhase::fine);
    theory.ki.add(as_given(study.units, p, p.controller.ki));
    theory.sampled_below.add(as_given(study.units, p, sampled_bound(0.0, p)));
    const double tau = slowest_time_constant(0.0, p.plant, p.encoder, fine, drive_of(p));
    if (std::isfinite(tau) && tau > 0.0) theory.slowest.add(tau);
  }
}

/// Form of the command and friction model are the same in all trials of a point.
std::string_view why_outside(const TrialParameters& first) {
  if (!first.command.torque.levels.empty()) return "the loop is open";
  switch (first.friction.model) {
    case FrictionModel::presliding:
    case FrictionModel::spring:
      return {};
    case FrictionModel::coulomb:
      return "friction.model coulomb has no spring before it slides";
    case FrictionModel::none:
      break;
  }
  return "friction.model none has no spring, which criteria (6) and (7) are about";
}

void add_sliding(SlidingPhase& phase, ControlPhase which, const TrialParameters& p) {
  const ControllerParameters controller = controller_in_phase(p.controller, which);
  const GainCrossover crossover = sliding_crossover(p.plant, p.encoder, controller, drive_of(p));
  if (!std::isnan(crossover.frequency)) {
    phase.bandwidth.add(crossover.frequency);
    phase.phase_margin.add(crossover.phase_margin);
  }
  const bool stable = stable_while_sliding(p.plant, p.encoder, controller, drive_of(p));
  phase.stable = phase.stable && stable;
  phase.unstable = phase.unstable && !stable;
}

/// Of the loops at the softest and the stiffest that the trial's contact can be, as far as they are stable.
Range time_constants(const TrialParameters& p, const FrictionParameters& contact) {
  Range slowest;
  for (const double stiffness : {contact.k1, contact.k1 + contact.k2}) {
    const double tau = slowest_time_constant(
        stiffness, p.plant, p.encoder, controller_in_phase(p.controller, ControlPhase::fine), drive_of(p));
    if (std::isfinite(tau) && tau > 0.0) slowest.add(tau);
  }
  return slowest;
}

/// The errors that moves begin with in the fine phase, counts; none where the reference is no step.
std::set<std::int64_t> steps_of(const TrialParameters& p) {
  std::set<std::int64_t> steps;
  if (p.command.profile.shape != ReferenceShape::step) return steps;
  const auto largest = has_coarse_phase(p.controller)
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

/// The trial's move that takes longest if its integral control is slow, with what it is judged by.
void add_arrivals(Arrival& longest, const TrialParameters& p, const FrictionParameters& contact) {
  if (!(p.controller.ki > 0.0)) return;
  const double judged = chatter_time(p.plant, contact, p.controller, p.verdict.dwell) +
                        std::max(p.verdict.dwell, p.verdict.window);
  for (const std::int64_t step : steps_of(p)) {
    const double time = slow_arrival_time(step, contact, p.encoder, p.controller) + judged;
    if (time > longest.time) longest = {step, time};
  }
}

/// Criterion (6) where the trial's contact has this k1.
void add_low_end(const Study& study, const TrialParameters& p, double k1, PointTheory& theory) {
  FrictionParameters contact = friction_at(p.friction, p.initial.position);
  contact.k1 = k1;
  theory.lowest_k1.add(k1);
  const IntegralGainBounds bounds = integral_gain_bounds(p.plant, contact, p.encoder, p.controller);
  theory.low_stable.add(as_given(study.units, p, bounds.stable_below));
}

/// The lowest k1 of the rotors of all rigs: trial i is on rig i mod rigs. The sampled loop, whose bound takes
/// longer to find, at the lowest of them.
void examine_rotors(const Study& study, std::int64_t point, PointTheory& theory) {
  theory.rigs = std::min(study.rigs, max_rigs_examined);
  TrialParameters softest;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::int64_t rig = 0; rig < theory.rigs; ++rig) {
    const TrialParameters p = study_trial(study, point, rig).parameters;
    const double k1 = lowest_k1(p.friction);
    add_low_end(study, p, k1, theory);
    if (k1 >= lowest) continue;
    lowest = k1;
    softest = p;
  }
  if (theory.rigs > 0) theory.low_sampled.add(as_given(study.units, softest, sampled_bound(lowest, softest)));
}

/// What holds for each of the trials examined, beyond the paper: the sampled loop at the lowest k1, its time
/// constants, and the loop while it slides.
void examine_beyond(const Study& study, std::int64_t point, PointTheory& theory) {
  theory.low_end = low_end(study, point, "friction.k1");
  const TrialParameters first = study_trial(study, point, 0).parameters;
  theory.hold = static_cast<double>(samples_of_move(first, 0)) / first.controller.sample_rate;
  theory.phases.push_back({has_coarse_phase(first.controller) ? "fine phase" : "loop", {}, {}});
  if (has_coarse_phase(first.controller)) theory.phases.push_back({"coarse phase", {}, {}});
  for (std::int64_t index = 0; index < std::min(study.trials, max_trials_examined_closely); ++index) {
    const TrialParameters p = study_trial(study, point, index).parameters;
    const FrictionParameters contact = friction_at(p.friction, p.initial.position);
    const Range slowest = time_constants(p, contact);
    if (slowest.low <= slowest.high) {
      theory.slowest.add(slowest.low);
      theory.slowest.add(slowest.high);
      add_arrivals(theory.longest, p, contact);
    }
    const double k1 =
        theory.low_end.kind == LowEnd::Kind::profile ? lowest_k1(p.friction) : theory.low_end.value;
    add_low_end(study, p, k1, theory);
    theory.low_sampled.add(as_given(study.units, p, sampled_bound(k1, p)));
    add_sliding(theory.phases[0], ControlPhase::fine, p);
    if (theory.phases.size() > 1) add_sliding(theory.phases[1], ControlPhase::coarse, p);
  }
  if (theory.low_end.kind == LowEnd::Kind::profile) examine_rotors(study, point, theory);
}

PointTheory examine(const Study& study, std::int64_t point) {
  PointTheory theory;
  theory.outside = why_outside(study_trial(study, point, 0).parameters);
  theory.gain_unit = unit_of(parameter_table()[find_parameter("controller.ki").value()], study.units);
  if (!theory.outside.empty()) {
    examine_free(study, point, theory);
    return theory;
  }
  theory.torque_unit = unit_on(study.units.axis, "N m");
  TrialParameters softest;
  TrialParameters stiffest;
  Range k1;  // N m/rad
  for (std::int64_t index = 0; index < std::min(study.trials, max_trials_examined); ++index) {
    const TrialParameters p = study_trial(study, point, index).parameters;
    const FrictionParameters contact = friction_at(p.friction, p.initial.position);
    const IntegralGainBounds bounds = integral_gain_bounds(p.plant, contact, p.encoder, p.controller);
    const double dac_bound = dac_resolution_bound(contact.k1, p.encoder, p.controller.encoder);
    theory.coarse_feedback = p.controller.encoder == EncoderChoice::coarse;
    theory.ki.add(as_given(study.units, p, p.controller.ki));
    theory.stable_below.add(as_given(study.units, p, bounds.stable_below));
    theory.unstable_above.add(as_given(study.units, p, bounds.unstable_above));
    theory.dac_resolution.add(p.dac.resolution);
    theory.dac_bound.add(dac_bound);
    theory.frequency.add(natural_frequency(contact.k1 + contact.k2, p.plant));
    theory.sample_rate.add(p.controller.sample_rate);
    theory.fine_enough = theory.fine_enough && p.dac.resolution < dac_bound;
    theory.fast_enough =
        theory.fast_enough && p.controller.sample_rate >= advised_sample_rate(p.plant, contact);
    theory.prediction.add(predict(p));
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
    case LowEnd::Kind::number:
      return "the one of the manifest";
    case LowEnd::Kind::support:
      return "the low end of its distribution";
    case LowEnd::Kind::tail:
      return "the 0.1 % quantile of its distribution";
    case LowEnd::Kind::profile:
      break;
  }
  if (theory.rigs == 0) return "the lowest along the profiles";
  return fmt::format("the lowest along the profiles of {} rigs", theory.rigs);
}

bool may_be_too_slow(const PointTheory& theory) {
  return theory.slowest.high > theory.hold || theory.longest.time > theory.hold;
}

/// "a move of 30 counts needs about 1 s"; empty where no move is a step.
std::string arrival_text(const Arrival& longest) {
  if (longest.step == 0) return {};
  return fmt::format("a move of {} count{} needs about {:.2g} s", longest.step, longest.step == 1 ? "" : "s",
                     longest.time);
}

std::string describe_beyond(const PointTheory& theory) {
  std::string out =
      fmt::format("    at the lowest k1, {} ({}): (6) stable below {:.3g} {}, sampled loop below {:.3g} {}\n",
                  text({theory.lowest_k1.low, theory.lowest_k1.low}), source_of(theory),
                  theory.low_stable.low, theory.gain_unit, theory.low_sampled.low, theory.gain_unit);
  if (theory.slowest.low <= theory.slowest.high) {
    const std::string arrival = arrival_text(theory.longest);
    out += fmt::format("    slowest time constant         {} s{}{}, hold {:.4g} s{}\n", text(theory.slowest),
                       arrival.empty() ? "" : "; ", arrival, theory.hold,
                       may_be_too_slow(theory) ? ": moves may end before they arrive" : "");
  }
  for (const SlidingPhase& phase : theory.phases) {
    const bool crosses = phase.bandwidth.low <= phase.bandwidth.high;
    out += fmt::format("    while sliding, the {} {}{}\n", phase.name,
                       crosses ? fmt::format("crosses gain 1 at {} Hz with a phase margin of {}°: ",
                                             text(phase.bandwidth), text(phase.phase_margin))
                               : "has no gain crossover: ",
                       phase.stable ? "stable" : (phase.unstable ? "unstable" : "unstable in some trials"));
  }
  return out;
}

/// What the sampled loop says of the integral gain.
std::string sampled_verdict(const PointTheory& theory) {
  if (theory.ki.high < theory.sampled_below.low) return "stable";
  return theory.ki.low >= theory.sampled_below.high ? "unstable" : "unstable in some trials";
}

std::string describe_outside(const PointTheory& theory) {
  std::string out = fmt::format("    the criteria are not about it: {}\n", theory.outside);
  if (!theory.free) return out;
  out += fmt::format("    ki                            {} {}: sampled loop {}\n", text(theory.ki),
                     theory.gain_unit, sampled_verdict(theory));
  out +=
      fmt::format("    sampled loop, below           {} {}\n", text(theory.sampled_below), theory.gain_unit);
  if (theory.slowest.low <= theory.slowest.high) {
    out += fmt::format("    slowest time constant         {} s, hold {:.4g} s{}\n", text(theory.slowest),
                       theory.hold, may_be_too_slow(theory) ? ": moves may end before they arrive" : "");
  }
  return out;
}

/// What criteria (6) and (7) and the sampled loop say of the integral gain.
std::string gain_verdict(const PointTheory& theory) {
  if (theory.ki.low == 0.0 && theory.ki.high == 0.0)
    return "no integral control: the error stays wherever friction holds the rest of the torque";
  return fmt::format("by (6) and (7) {}; sampled loop at k1 {}", verdict(theory.prediction),
                     sampled_verdict(theory));
}

std::string describe(const PointTheory& theory) {
  if (!theory.outside.empty()) return describe_outside(theory);
  std::string out;
  const std::string& unit = theory.gain_unit;
  out += fmt::format("    ki                            {} {}: {}\n", text(theory.ki), unit,
                     gain_verdict(theory));
  out += fmt::format("    (6) stable below              {} {}\n", text(theory.stable_below), unit);
  out += fmt::format("    sampled loop at k1, below     {} {}\n", text(theory.sampled_below), unit);
  out += fmt::format("    (7) unstable above            {} {}\n", text(theory.unstable_above), unit);
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

/// The input columns of which `belongs` holds, after `title`; nothing where there are none.
template <class Belongs>
void print_columns(const Study& study, std::string_view title, const Belongs& belongs) {
  std::string names;
  for (const InputColumn& column : study.input_columns) {
    if (belongs(column.per)) names += " " + column.name;
  }
  if (!names.empty()) fmt::print("  {}:{}\n", title, names);
}

void print_what_differs(const Study& study) {
  if (study.input_columns.empty()) fmt::print("  differing between trials: nothing\n");
  print_columns(study, "differing between trials",
                [](Per per) { return per == Per::trial || per == Per::contact; });
  print_columns(study, "of these, drawn anew at each contact", [](Per per) { return per == Per::contact; });
  print_columns(study, "differing between rigs", [](Per per) { return per == Per::rig; });
  print_columns(study, "the same in all trials of a point", [](Per per) { return per == Per::study; });
}

void print_plan(const Study& study) {
  const StudyCost cost = measure_cost(study);
  fmt::print("{}: {}\n", study.name, study.description.empty() ? "(no description)" : study.description);
  fmt::print("  {} design point{} × {} trials = {} trials, {} move{} each\n", point_count(study),
             point_count(study) == 1 ? "" : "s", study.trials, trial_count(study), study.moves,
             study.moves == 1 ? "" : "s");
  if (study.rigs > 0) {
    fmt::print("  at each point {} rigs × {} trials of each\n", study.rigs, study.trials / study.rigs);
  }
  if (study.stop) {
    fmt::print(
        "  or fewer: after every {} at each point it ends where all success rates are known to ± {:.4g}\n",
        study.stop->block, study.stop->success_rate_halfwidth);
    if (study.rigs > 0) {
      fmt::print(
          "  (of these {} rigs: how far others differ from them, more trials do not tell; see 'zerocount "
          "plan "
          "--rig-sd')\n",
          study.rigs);
    }
  }
  fmt::print("  {:.4g} samples at {:.0f} ns: about {} on {} core{}\n", cost.samples,
             1e9 * cost.seconds_per_sample, duration_text(cost.seconds()), cost.cores,
             cost.cores == 1 ? "" : "s");
  const StudySize size = measure_size(study);
  fmt::print("  results file about {}; while it runs up to {} on the disk and {} of memory\n",
             bytes_text(size.file_bytes), bytes_text(size.file_bytes + size.shard_bytes),
             bytes_text(size.memory_bytes));
  print_what_differs(study);
}

void warn_of_slowness(std::int64_t point, const std::string& label, const PointTheory& theory) {
  const std::string arrival = arrival_text(theory.longest);
  const std::string slow =
      theory.slowest.high > theory.hold
          ? fmt::format("the loop's slowest time constant, {:.3g} s, exceeds the hold of {:.4g} s{}{}",
                        theory.slowest.high, theory.hold, arrival.empty() ? "" : "; ", arrival)
          : fmt::format("the loop's slowest time constant is {:.3g} s; {}, longer than the hold of {:.4g} s",
                        theory.slowest.high, arrival, theory.hold);
  fmt::print(stderr, "warning: point {} ({}): {}: moves may end before they arrive\n", point, label, slow);
}

ExitCode check(const Arguments& arguments) {
  const Study study = load_study(arguments.operands()[0], arguments.values("set"));
  warn(study);
  print_plan(study);
  fmt::print("\nTheory, over the first {} trials of each point, each with the friction it starts on:\n",
             std::min(study.trials, max_trials_examined));
  const std::int64_t shown =
      arguments.has("all-points") ? point_count(study) : std::min(point_count(study), points_shown);
  for (std::int64_t point = 0; point < shown; ++point) {
    const PointTheory theory = examine(study, point);
    const std::string& label = study.point_labels[static_cast<std::size_t>(point)];
    fmt::print("  point {}: {}\n{}", point, label, describe(theory));
    if (may_be_too_slow(theory)) warn_of_slowness(point, label, theory);
  }
  if (shown < point_count(study)) {
    fmt::print("  … and {} more points (--all-points shows them)\n", point_count(study) - shown);
  }
  return ExitCode::success;
}

}  // namespace

Command check_command() {
  return {{"check",
           "MANIFEST",
           1,
           1,
           {{"set", "KEY=VALUE", "override a manifest key; may be repeated", true},
            {"all-points", "", "print the theory of every design point, not only of the first 20"}}},
          "validate a manifest; print its plan and what the theory says",
          check_help,
          check};
}

}  // namespace zerocount
