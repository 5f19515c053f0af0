#include "runners/commands/point_theory_text.hpp"

#include <set>
#include <vector>

#include <fmt/format.h>

namespace zerocount::commands {
namespace {

using theory::PointTheory;
using theory::Range;

std::string text(const Range& range) {
  if (range.low == range.high) return fmt::format("{:.3g}", range.low);
  return fmt::format("{:.3g} … {:.3g}", range.low, range.high);
}

std::string stability_text(const std::set<theory::LoopStability>& stability) {
  using theory::LoopStability;
  if (stability == std::set{LoopStability::stable}) return "stable";
  if (stability == std::set{LoopStability::unstable}) return "unstable";
  if (stability.count(LoopStability::unstable) > 0) return "unstable in some trials";
  return "marginal, with an eigenvalue of 1";
}

std::string margins_text(const theory::LoopRanges& loop) {
  const std::string gain =
      loop.gain.empty() ? "no phase crossover"
                        : fmt::format("gain margin {} dB at {} Hz", text(loop.gain), text(loop.gain_at));
  const std::string phase =
      loop.phase.empty() ? "no gain crossover"
                         : fmt::format("phase margin {}° at {} Hz", text(loop.phase), text(loop.phase_at));
  return gain + ", " + phase;
}

std::string loop_lines(const std::vector<theory::LoopRanges>& loops) {
  std::string out;
  for (const theory::LoopRanges& loop : loops) {
    const std::string bandwidth =
        loop.bandwidth.empty() ? "" : fmt::format("crosses gain 1 at {} Hz, ", text(loop.bandwidth));
    const char* const separator = loop.slides ? ": " : ", ";
    out += fmt::format("    {}{}{}{}: {}\n", loop.name, separator, bandwidth, margins_text(loop),
                       stability_text(loop.stability));
  }
  return out;
}

std::string source_text(const theory::LowestStiffness& lowest) {
  switch (lowest.source.kind) {
    case study::LowEnd::Kind::number:
      return "the one of the manifest";
    case study::LowEnd::Kind::support:
      return "the low end of its distribution";
    case study::LowEnd::Kind::tail:
      return "the 0.1 % quantile of its distribution";
    case study::LowEnd::Kind::profile:
      break;
  }
  if (lowest.rigs == 0) return "the lowest along the profiles";
  return fmt::format("the lowest along the profiles of {} rigs", lowest.rigs);
}

std::string lowest_line(const theory::LowestStiffness& lowest, const theory::GainTheory& gain) {
  const std::string criterion =
      gain.left_out.empty() ? fmt::format("(6) stable below {:.3g} {}, ", lowest.stable_below.low, gain.unit)
                            : "";
  return fmt::format("    at the lowest k1, {:.3g} ({}): {}sampled loop below {:.3g} {}\n", lowest.k1.low,
                     source_text(lowest), criterion, lowest.sampled_below.low, gain.unit);
}

/// "a move of 30 counts needs about 1 s"; empty where no move is a step.
std::string arrival_text(const theory::Approach& approach) {
  if (approach.longest_step == 0) return {};
  return fmt::format("a move of {} needs about {:.2g} s", counted(approach.longest_step, "count"),
                     approach.longest_time);
}

/// The line of the slowest time constant; empty if no loop is stable.
std::string slowness_line(const theory::Approach& approach) {
  if (approach.time_constant.empty()) return {};
  const std::string arrival = arrival_text(approach);
  return fmt::format("    slowest time constant         {} s{}{}, hold {:.4g} s{}\n",
                     text(approach.time_constant), arrival.empty() ? "" : "; ", arrival, approach.hold,
                     approach.exceeds_hold() ? ": moves may end before they arrive" : "");
}

/// "    (6) stable below              1 … 2 N m/count".
std::string range_line(std::string_view name, const Range& range, std::string_view unit) {
  return fmt::format("    {:<29} {} {}", name, text(range), unit);
}

/// Verdict of the sampled loop on the integral gain.
std::string sampled_verdict(const theory::GainTheory& gain) {
  if (gain.sampled_stable == std::set{true}) return "stable";
  return gain.sampled_stable == std::set{false} ? "unstable" : "unstable in some trials";
}

std::string cycle_lines(std::string_view method, const std::vector<theory::LimitCycle>& cycles,
                        const theory::HuntingPrediction& hunting) {
  const std::string start = fmt::format("    hunting of trial 0, {}: ", method);
  std::string lines;
  for (const theory::LimitCycle& cycle : cycles) {
    lines += fmt::format("{}amplitude {:.4g} counts, period {:.4g} s\n", start,
                         cycle.amplitude / hunting.count_angle, cycle.period);
  }
  if (!lines.empty()) return lines;
  return fmt::format("{}no lasting cycle{}\n", start,
                     hunting.grows_while_sliding
                         ? "; the loop is unstable while the rotor slides: what has broken loose may grow"
                         : "");
}

std::string hunting_lines(const theory::HuntingPrediction& hunting) {
  if (!hunting.left_out.empty())
    return fmt::format("    hunting of trial 0: not predicted, since the predictions leave out {}\n",
                       hunting.left_out);
  const std::string lines = cycle_lines("by describing function", hunting.by_function, hunting);
  return hunting.sticks ? lines + cycle_lines("by stick-slip", hunting.by_stick_slip, hunting) : lines;
}

std::string describe_outside(const PointTheory& theory) {
  std::string out = fmt::format("    the criteria do not apply: {}\n", theory.outside);
  if (theory.hunting) out += hunting_lines(*theory.hunting);
  const theory::GainTheory& gain = theory.gain;
  if (theory.free) {
    out += range_line(gain.name, gain.value, gain.unit) + ": sampled loop " + sampled_verdict(gain) + "\n" +
           range_line("sampled loop, below", gain.sampled_below, gain.unit) + "\n" +
           slowness_line(theory.approach);
  }
  return out + loop_lines(theory.loops);
}

/// Verdict of the criteria (6) and (7) and of the sampled loop on the integral gain.
std::string gain_verdict(const theory::GainTheory& gain) {
  if (gain.value.low == 0.0 && gain.value.high == 0.0) {
    return gain.observes
               ? "no integral: the disturbance observer takes its place"
               : "no integral control: the error stays wherever friction holds the rest of the torque";
  }
  const std::string by_criteria =
      gain.left_out.empty()
          ? fmt::format("by (6) and (7) {}; ", theory::verdict(gain.prediction))
          : fmt::format("(6) and (7) do not apply, since they leave out {}; ", gain.left_out);
  return fmt::format("{}sampled loop at k1 {}", by_criteria, sampled_verdict(gain));
}

std::string gain_lines(const theory::GainTheory& gain) {
  const bool applies = gain.left_out.empty();
  std::string out = range_line(gain.name, gain.value, gain.unit) + ": " + gain_verdict(gain) + "\n";
  if (applies) out += range_line("(6) stable below", gain.stable_below, gain.unit) + "\n";
  out += range_line("sampled loop at k1, below", gain.sampled_below, gain.unit) + "\n";
  if (applies) out += range_line("(7) unstable above", gain.unstable_above, gain.unit) + "\n";
  return out;
}

/// "holds", "holds in 3 of 200 trials", "holds in no trial".
std::string holds_text(std::int64_t holding, std::int64_t trials) {
  if (holding == trials) return "holds";
  return holding == 0 ? "holds in no trial" : fmt::format("holds in {} of {} trials", holding, trials);
}

std::string rule_lines(const theory::DesignRules& rules) {
  return fmt::format("    DAC: resolution {} {}, must be below k1·Δx = {} {}{}: {}\n",
                     text(rules.dac_resolution), rules.torque_unit, text(rules.dac_bound), rules.torque_unit,
                     rules.coarse_feedback ? " with the Δx of the coarse encoder" : "",
                     holds_text(rules.fine_enough, rules.trials)) +
         fmt::format("    natural frequency {} Hz, sample rate {} Hz: {}\n", text(rules.frequency),
                     text(rules.sample_rate),
                     rules.fast_enough == rules.trials
                         ? "ten times that, as advised"
                         : fmt::format("ten times that, which is advised, {}",
                                       holds_text(rules.fast_enough, rules.trials)));
}

}  // namespace

std::string counted(std::int64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string slowness_text(const theory::Approach& approach) {
  const std::string arrival = arrival_text(approach);
  const double slowest = approach.time_constant.high;
  if (slowest > approach.hold) {
    return fmt::format(", {:.3g} s, exceeds the hold of {:.4g} s{}{}", slowest, approach.hold,
                       arrival.empty() ? "" : "; ", arrival);
  }
  return fmt::format(" is {:.3g} s; {}, longer than the hold of {:.4g} s", slowest, arrival, approach.hold);
}

std::string describe(const PointTheory& theory) {
  if (!theory.outside.empty()) return describe_outside(theory);
  return gain_lines(theory.gain) + rule_lines(theory.rules) + lowest_line(theory.lowest, theory.gain) +
         slowness_line(theory.approach) + loop_lines(theory.loops);
}

}  // namespace zerocount::commands
