#include <string>

#include <fmt/format.h>

#include "runners/commands/point_theory.hpp"

namespace zerocount::commands {
namespace {

std::string text(const Range& range) {
  if (range.low == range.high) return fmt::format("{:.3g}", range.low);
  return fmt::format("{:.3g} … {:.3g}", range.low, range.high);
}

std::string stability_text(const MarginRanges& margins) {
  using theory::LoopStability;
  if (margins.stability == std::set{LoopStability::stable}) return "stable";
  if (margins.stability == std::set{LoopStability::unstable}) return "unstable";
  if (margins.stability.count(LoopStability::unstable) > 0) return "unstable in some trials";
  return "marginal, with an eigenvalue of 1";
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

std::string loop_lines(const PointTheory& theory) {
  std::string out;
  for (const LoopRanges& loop : theory.loops) {
    const std::string bandwidth =
        loop.bandwidth.empty() ? "" : fmt::format("crosses gain 1 at {} Hz, ", text(loop.bandwidth));
    const char* const separator = loop.slides ? ": " : ", ";
    out += fmt::format("    {}{}{}{}: {}\n", loop.name, separator, bandwidth, margins_text(loop.margins),
                       stability_text(loop.margins));
  }
  return out;
}

std::string describe_beyond(const PointTheory& theory) {
  const std::string criterion = theory.left_out.empty() ? fmt::format("(6) stable below {:.3g} {}, ",
                                                                      theory.low_stable.low, theory.gain_unit)
                                                        : "";
  std::string out = fmt::format("    at the lowest k1, {} ({}): {}sampled loop below {:.3g} {}\n",
                                text({theory.lowest_k1.low, theory.lowest_k1.low}), source_of(theory),
                                criterion, theory.low_sampled.low, theory.gain_unit);
  out += slowness_line(theory);
  return out + loop_lines(theory);
}

/// "    (6) stable below              1 … 2 N m/count".
std::string range_line(std::string_view name, const Range& range, std::string_view unit) {
  return fmt::format("    {:<29} {} {}", name, text(range), unit);
}

/// Verdict of the sampled loop on the integral gain.
std::string sampled_verdict(const PointTheory& theory) {
  if (theory.sampled_stable == std::set{true}) return "stable";
  return theory.sampled_stable == std::set{false} ? "unstable" : "unstable in some trials";
}

std::string describe_outside(const PointTheory& theory) {
  std::string out = fmt::format("    the criteria do not apply: {}\n", theory.outside);
  if (!theory.free) return out + theory.hunting + loop_lines(theory);
  return out + range_line(theory.gain_name, theory.ki, theory.gain_unit) + ": sampled loop " +
         sampled_verdict(theory) + "\n" +
         range_line("sampled loop, below", theory.sampled_below, theory.gain_unit) + "\n" +
         slowness_line(theory) + loop_lines(theory);
}

/// Verdict of the criteria (6) and (7) and of the sampled loop on the integral gain.
std::string gain_verdict(const PointTheory& theory) {
  if (theory.ki.low == 0.0 && theory.ki.high == 0.0) {
    return theory.observes
               ? "no integral: the disturbance observer takes its place"
               : "no integral control: the error stays wherever friction holds the rest of the torque";
  }
  const std::string by_criteria =
      theory.left_out.empty()
          ? fmt::format("by (6) and (7) {}; ", measures::verdict(theory.prediction))
          : fmt::format("(6) and (7) do not apply, since they leave out {}; ", theory.left_out);
  return fmt::format("{}sampled loop at k1 {}", by_criteria, sampled_verdict(theory));
}

}  // namespace

std::string counted(std::int64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

bool may_be_too_slow(const PointTheory& theory) {
  return theory.slowest.high > theory.hold || theory.longest.time > theory.hold;
}

std::string slowness_text(const PointTheory& theory) {
  const std::string arrival = arrival_text(theory.longest);
  if (theory.slowest.high > theory.hold) {
    return fmt::format(", {:.3g} s, exceeds the hold of {:.4g} s{}{}", theory.slowest.high, theory.hold,
                       arrival.empty() ? "" : "; ", arrival);
  }
  return fmt::format(" is {:.3g} s; {}, longer than the hold of {:.4g} s", theory.slowest.high, arrival,
                     theory.hold);
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

}  // namespace zerocount::commands
