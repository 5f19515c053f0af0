#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/trials/theory/point_theory.hpp"

namespace zerocount::theory {
namespace {

using document::Description;
using document::everywhere;
using document::in_data;
using document::range_text;
using std::optional;
using std::string;

/// Text of a range of stability margins: "18 dB at 40 Hz"; nothing if no trial has a crossover.
optional<string> margin_text(const Range& margin, const char* unit, const Range& frequency) {
  const optional<string> found = range_text(margin, unit);
  if (!found) return {};
  return *found + " at " + range_text(frequency, "Hz").value_or("–");
}

string gain_margin_text(const LoopRanges& loop) {
  const optional<string> found = margin_text(loop.gain, "dB", loop.gain_at);
  if (!found) return loop.no_gain_stabilises ? string(no_gain_text) : "no phase crossover";
  return *found + (loop.no_gain_stabilises ? "; in some trials no gain stabilises it" : "");
}

string phase_margin_text(const LoopRanges& loop) {
  return margin_text(loop.phase, "°", loop.phase_at).value_or("no gain crossover");
}

/// Adds output items for a stability margin with its frequency.
/// @param text text for people
void add_margin(Description<LoopRanges>& description, const string& key, const string& name, const char* unit,
                Range LoopRanges::*margin, Range LoopRanges::*frequency, string (*text)(const LoopRanges&)) {
  description.value(everywhere(key, name, name, unit), margin)
      .shown_as(text)
      .value(in_data(key + "_at", "frequency of the " + name, "Hz"), frequency);
}

std::string_view to_string(LoopStability stability) {
  switch (stability) {
    case LoopStability::stable:
      return "stable";
    case LoopStability::marginal:
      return "marginal";
    case LoopStability::unstable:
      break;
  }
  return "unstable";
}

std::vector<string> stabilities(const LoopRanges& loop) {
  std::vector<string> words;
  for (const LoopStability one : loop.stability) words.emplace_back(to_string(one));
  return words;
}

Description<GainTheory> gain_description() {
  const auto is_zero = [](const GainTheory& gain) { return gain.value.low == 0.0 && gain.value.high == 0.0; };
  Description<GainTheory> description;
  description.value(in_data("gain_name", "name of the integral gain"), &GainTheory::name)
      .value(in_data("gain_unit", "unit of the gain and its bounds"), &GainTheory::unit);
  const auto add_gain = [&](const char* key, const char* heading, const char* meaning,
                            Range GainTheory::*gain) {
    description.value(everywhere(key, heading, meaning), gain).shown_as([gain](const GainTheory& of) {
      return range_text(of.*gain, of.unit);
    });
  };
  add_gain("gain", "integral gain", "integral gain", &GainTheory::value);
  description
      .value(everywhere("integral", "integral", "why there is no integral; null: there is one"),
             [=](const GainTheory& gain) -> optional<string> {
               if (!is_zero(gain)) return {};
               return gain.observes ? "none: the disturbance observer takes its place"
                                    : "none: the error stays wherever friction holds the rest of the torque";
             })
      .value(everywhere("criteria", "by (6) and (7)", "verdict of the paper's criteria (6) and (7)"),
             [=](const GainTheory& gain) -> optional<string> {
               if (is_zero(gain)) return {};
               if (!gain.left_out.empty())
                 return fmt::format("do not apply, since they leave out {}", gain.left_out);
               if (predicted_trials(gain.prediction) == 0) return {};
               return verdict(gain.prediction);
             })
      .value(in_data("criteria_trials", "trials that the criteria were tried in"),
             [](const GainTheory& gain) { return gain.prediction.trials; })
      .value(in_data("criteria_stable", "trials in which (6) holds"),
             [](const GainTheory& gain) { return gain.prediction.stable; })
      .value(in_data("criteria_unstable", "trials in which (7) is exceeded"),
             [](const GainTheory& gain) { return gain.prediction.unstable; })
      .value(everywhere("sampled", "sampled loop", "verdict of the sampled loop at k1, or without a spring"),
             [=](const GainTheory& gain) -> optional<string> {
               if (is_zero(gain)) return {};
               if (gain.sampled_stable == std::set{true}) return "stable";
               return gain.sampled_stable == std::set{false} ? "unstable" : "unstable in some trials";
             });
  add_gain("stable_below", "(6) stable below", "bound of criterion (6)", &GainTheory::stable_below);
  add_gain("sampled_below", "sampled loop, stable below", "bound of the sampled loop",
           &GainTheory::sampled_below);
  add_gain("unstable_above", "(7) unstable above", "bound of criterion (7)", &GainTheory::unstable_above);
  return description;
}

/// Text on the number of trials in which a rule holds: "holds", "holds in 3 of 200 trials", "holds in no
/// trial".
string holds_text(std::int64_t holding, std::int64_t trials) {
  if (holding == trials) return "holds";
  return holding == 0 ? "holds in no trial" : fmt::format("holds in {} of {} trials", holding, trials);
}

Description<DesignRules> rules_description() {
  return Description<DesignRules>()
      .value(everywhere("dac_resolution", "DAC resolution", "torque of a code of the DAC"),
             &DesignRules::dac_resolution)
      .shown_as([](const DesignRules& rules) {
        return fmt::format("{}, below k1·Δx = {}{} (paper, issue 4): {}",
                           *range_text(rules.dac_resolution, rules.torque_unit),
                           range_text(rules.dac_bound, rules.torque_unit).value_or("–"),
                           rules.coarse_feedback ? " with the Δx of the coarse encoder" : "",
                           holds_text(rules.fine_enough, rules.trials));
      })
      .value(in_data("dac_bound", "bound of the rule for the DAC"), &DesignRules::dac_bound)
      .value(in_data("torque_unit", "unit of both"), &DesignRules::torque_unit)
      .value(in_data("coarse_feedback", "whether the bound is of the coarse encoder"),
             &DesignRules::coarse_feedback)
      .value(in_data("rule_trials", "trials that the rules were tried in"), &DesignRules::trials)
      .value(in_data("fine_enough", "trials in which the DAC satisfies its rule"), &DesignRules::fine_enough)
      .value(in_data("fast_enough", "trials in which the sample rate satisfies its rule"),
             &DesignRules::fast_enough)
      .value(everywhere("natural_frequency", "natural frequency", "natural frequency on k1 + k2", "Hz"),
             &DesignRules::frequency)
      .value(everywhere("sample_rate", "sample rate", "sample rate", "Hz"), &DesignRules::sample_rate)
      .shown_as([](const DesignRules& rules) {
        return fmt::format("{}, at least {:.3g} times the natural frequency (paper: 10): {}",
                           *range_text(rules.sample_rate, "Hz"), rules.sample_rate.low / rules.frequency.high,
                           holds_text(rules.fast_enough, rules.trials));
      });
}

string source_text(const LowestStiffness& lowest) {
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
  if (lowest.machines == 0) return "the lowest along the profiles";
  return fmt::format("the lowest along the profiles of {} machines", lowest.machines);
}

Description<PointTheory> lowest_description() {
  const auto in_unit = [](const PointTheory& theory, double bound) {
    return fmt::format("{:.3g} {}", bound, theory.gain.unit);
  };
  return Description<PointTheory>()
      .value(everywhere("lowest_k1", "lowest k1", "lowest stiffness k1 of the study"),
             [](const PointTheory& t) { return t.lowest.k1.low; })
      .shown_as([](const PointTheory& t) {
        return fmt::format("{:.3g}, {}", t.lowest.k1.low, source_text(t.lowest));
      })
      .value(in_data("lowest_k1_source", "where it is from"),
             [](const PointTheory& t) { return source_text(t.lowest); })
      .value(everywhere("lowest_stable_below", "at the lowest k1: (6) stable below",
                        "bound of criterion (6) there, in the unit of the gain"),
             [](const PointTheory& t) -> optional<double> {
               if (!std::isfinite(t.lowest.stable_below.low)) return {};  // the criterion does not apply
               return t.lowest.stable_below.low;
             })
      .shown_as([=](const PointTheory& t) -> optional<string> {
        if (!std::isfinite(t.lowest.stable_below.low)) return {};
        return in_unit(t, t.lowest.stable_below.low);
      })
      .value(everywhere("lowest_sampled_below", "at the lowest k1: sampled loop below",
                        "bound of the sampled loop there, in the unit of the gain"),
             [](const PointTheory& t) { return t.lowest.sampled_below.low; })
      .shown_as([=](const PointTheory& t) { return in_unit(t, t.lowest.sampled_below.low); });
}

/// Text on the slowest move: "a move of 30 counts needs about 1 s"; nothing if no move is a step.
optional<string> arrival_text(const Approach& approach) {
  if (approach.longest_step == 0) return {};
  return fmt::format("a move of {} count{} needs about {:.2g} s", approach.longest_step,
                     approach.longest_step == 1 ? "" : "s", approach.longest_time);
}

Description<Approach> approach_description() {
  return Description<Approach>()
      .value(everywhere("time_constant", "slowest time constant", "slowest time constant of the loop", "s"),
             &Approach::time_constant)
      .value(everywhere("hold", "hold", "time that the shortest move is held", "s"), &Approach::hold)
      .value(everywhere("longest_step", "slowest move", "length of the slowest move; 0: no step", "count"),
             &Approach::longest_step)
      .shown_as(arrival_text)
      .value(in_data("longest_time", "time that it needs, with the dwell", "s"), &Approach::longest_time)
      .value(everywhere("exceeds_hold", "warning", "whether moves may end before they arrive"),
             &Approach::exceeds_hold)
      .shown_as([](const Approach& approach) -> optional<string> {
        if (!approach.exceeds_hold()) return {};
        return "moves may end before they arrive";
      });
}

}  // namespace

string slowness_text(const Approach& approach) {
  const string arrival = arrival_text(approach).value_or("");
  const double slowest = approach.of_moves.high;
  const char* const kind = slowest < approach.time_constant.high ? " without oscillation" : "";
  if (slowest > approach.hold) {
    return fmt::format("{}, {:.3g} s, exceeds the hold of {:.4g} s{}{}", kind, slowest, approach.hold,
                       arrival.empty() ? "" : "; ", arrival);
  }
  return fmt::format("{} is {:.3g} s; {}, longer than the hold of {:.4g} s", kind, slowest, arrival,
                     approach.hold);
}

string stability_text(const LoopRanges& loop) {
  const std::set<LoopStability>& stability = loop.stability;
  if (stability == std::set{LoopStability::stable}) {
    if (loop.slow.empty()) return "stable";
    return "stable, with a time constant of " + *range_text(loop.slow, "s") + ", longer than the hold";
  }
  if (stability == std::set{LoopStability::unstable}) return "unstable";
  if (stability.count(LoopStability::unstable) > 0) return "unstable in some trials";
  return stability.count(LoopStability::stable) > 0
             ? "stable; in some trials marginal: a motion neither grows nor dies out within the hold"
             : "marginal: a motion neither grows nor dies out within the hold";
}

Description<LoopRanges> loop_description() {
  Description<LoopRanges> description;
  description.value(everywhere("loop", "loop", "where the rotor is"), &LoopRanges::name)
      .value(in_data("slides", "whether the rotor slides"), &LoopRanges::slides)
      .value(everywhere("stability", "verdict", "stable, marginal or unstable: all that occur in the trials"),
             stabilities)
      .shown_as(stability_text)
      .value(in_data("slow", "slowest time constants longer than the hold", "s"), &LoopRanges::slow)
      .value(everywhere("bandwidth", "crosses gain 1 at", "bandwidth while it slides", "Hz"),
             &LoopRanges::bandwidth);
  add_margin(description, "gain_margin", "gain margin", "dB", &LoopRanges::gain, &LoopRanges::gain_at,
             gain_margin_text);
  add_margin(description, "phase_margin", "phase margin", "°", &LoopRanges::phase, &LoopRanges::phase_at,
             phase_margin_text);
  description.value(in_data("no_gain_stabilises",
                            "whether the loop is unstable with every factor of its gain, in some trial"),
                    &LoopRanges::no_gain_stabilises);
  return description;
}

Description<PointTheory> point_theory_description() {
  const auto applies = [](const PointTheory& theory) { return theory.outside.empty(); };
  return Description<PointTheory>()
      .value(
          everywhere("outside", "the criteria do not apply", "why (6) and (7) do not apply; null: they do"),
          [=](const PointTheory& t) { return applies(t) ? std::nullopt : optional(t.outside); })
      .include(gain_description(),
               [=](const PointTheory& t) { return applies(t) || t.free ? &t.gain : nullptr; })
      .include(rules_description(), [=](const PointTheory& t) { return applies(t) ? &t.rules : nullptr; })
      .include(lowest_description(), [=](const PointTheory& t) { return applies(t) ? &t : nullptr; })
      .include(approach_description(),
               [=](const PointTheory& t) {
                 return (applies(t) || t.free) && !t.approach.time_constant.empty() ? &t.approach : nullptr;
               })
      .table(
          in_data(
              "loops",
              "the loops in which the machine moves: at k1, at k1 + k2, at the ends of a profile and while the rotor slides, in each state of the load"),
          loop_description(), &PointTheory::loops)
      .value(everywhere("cut", "without a loop",
                        "states of the load in which no encoder that the controller reads sees the motor"),
             &PointTheory::cut)
      .shown_as([](const PointTheory& t) -> optional<string> {
        if (t.cut.empty()) return {};
        return fmt::format("{}: no encoder that the controller reads sees the motor there",
                           fmt::join(t.cut, ", "));
      });
}

}  // namespace zerocount::theory
