#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/theory/point_theory.hpp"

namespace zerocount::theory {
namespace {

using document::Description;
using document::everywhere;
using document::in_data;
using std::optional;
using std::string;

string range_text(const Range& range) {
  if (range.low == range.high) return fmt::format("{:.3g}", range.low);
  return fmt::format("{:.3g} … {:.3g}", range.low, range.high);
}

/// A range: in JSON an object, for people a text; nothing where it is empty.
template <class Row, class Get>
void add_range(Description<Row>& description, const char* key, const string& heading, const string& meaning,
               Get get, const string& unit = {}) {
  const auto found = [get](const Row& row) -> const Range* {
    const Range& range = std::invoke(get, row);
    return range.empty() ? nullptr : &range;
  };
  description
      .object(everywhere(key, heading, meaning + ", over the trials", unit),
              Description<Range>()
                  .value(in_data("low", "smallest", unit), &Range::low)
                  .value(in_data("high", "largest", unit), &Range::high),
              found)
      .shown_as([found, unit](const Row& row) -> optional<string> {
        const Range* const range = found(row);
        if (range == nullptr) return {};
        return range_text(*range) + (unit.empty() ? "" : " " + unit);
      });
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
  using Of = const GainTheory&;
  const auto is_zero = [](Of gain) { return gain.value.low == 0.0 && gain.value.high == 0.0; };
  Description<GainTheory> description;
  description.value(in_data("gain_name", "name of the integral gain"), &GainTheory::name)
      .value(everywhere("gain_unit", "unit of gains", "unit of the gain and its bounds"), &GainTheory::unit);
  add_range(description, "gain", "integral gain", "integral gain", &GainTheory::value);
  description
      .value(everywhere("integral", "integral", "why there is no integral; null: there is one"),
             [=](Of gain) -> optional<string> {
               if (!is_zero(gain)) return {};
               return gain.observes ? "none: the disturbance observer takes its place"
                                    : "none: the error stays wherever friction holds the rest of the torque";
             })
      .value(everywhere("criteria", "by (6) and (7)", "verdict of the paper's criteria (6) and (7)"),
             [=](Of gain) -> optional<string> {
               if (is_zero(gain)) return {};
               if (!gain.left_out.empty())
                 return fmt::format("do not apply, since they leave out {}", gain.left_out);
               if (predicted_trials(gain.prediction) == 0) return {};
               return verdict(gain.prediction);
             })
      .value(in_data("criteria_trials", "trials that the criteria were tried in"),
             [](Of gain) { return gain.prediction.trials; })
      .value(in_data("criteria_stable", "trials in which (6) holds"),
             [](Of gain) { return gain.prediction.stable; })
      .value(in_data("criteria_unstable", "trials in which (7) is exceeded"),
             [](Of gain) { return gain.prediction.unstable; })
      .value(everywhere("sampled", "sampled loop", "verdict of the sampled loop at k1, or without a spring"),
             [=](Of gain) -> optional<string> {
               if (is_zero(gain)) return {};
               if (gain.sampled_stable == std::set{true}) return "stable";
               return gain.sampled_stable == std::set{false} ? "unstable" : "unstable in some trials";
             });
  add_range(description, "stable_below", "(6) stable below", "bound of criterion (6)",
            &GainTheory::stable_below);
  add_range(description, "sampled_below", "sampled loop, stable below", "bound of the sampled loop",
            &GainTheory::sampled_below);
  add_range(description, "unstable_above", "(7) unstable above", "bound of criterion (7)",
            &GainTheory::unstable_above);
  return description;
}

Description<DesignRules> rules_description() {
  Description<DesignRules> description;
  add_range(description, "dac_resolution", "code of the DAC", "torque of a code of the DAC",
            &DesignRules::dac_resolution);
  add_range(description, "dac_bound", "k1·Δx, above a code (paper, issue 4)", "bound of the rule for the DAC",
            &DesignRules::dac_bound);
  description.value(everywhere("torque_unit", "unit of both", "unit of both"), &DesignRules::torque_unit)
      .value(in_data("coarse_feedback", "whether the bound is of the coarse encoder"),
             &DesignRules::coarse_feedback)
      .value(everywhere("rule_trials", "trials tried", "trials that the rules were tried in"),
             &DesignRules::trials)
      .value(everywhere("fine_enough", "trials with a code below it",
                        "trials in which the DAC satisfies its rule"),
             &DesignRules::fine_enough)
      .value(everywhere("fast_enough", "trials sampled fast enough",
                        "trials in which the sample rate satisfies its rule"),
             &DesignRules::fast_enough);
  add_range(description, "natural_frequency", "natural frequency", "natural frequency on k1 + k2",
            &DesignRules::frequency, "Hz");
  add_range(description, "sample_rate", "sample rate, 10 times that (paper)", "sample rate",
            &DesignRules::sample_rate, "Hz");
  return description;
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
  if (lowest.rigs == 0) return "the lowest along the profiles";
  return fmt::format("the lowest along the profiles of {} rigs", lowest.rigs);
}

Description<LowestStiffness> lowest_description() {
  using Of = const LowestStiffness&;
  return Description<LowestStiffness>()
      .value(everywhere("lowest_k1", "lowest k1", "lowest stiffness k1 of the study"),
             [](Of l) { return l.k1.low; })
      .value(everywhere("lowest_k1_source", "source of the lowest k1", "where it is from"), source_text)
      .value(everywhere("lowest_stable_below", "at the lowest k1: (6) stable below",
                        "bound of criterion (6) there, in the unit of the gain"),
             [](Of l) { return l.stable_below.low; })
      .value(everywhere("lowest_sampled_below", "at the lowest k1: sampled loop below",
                        "bound of the sampled loop there, in the unit of the gain"),
             [](Of l) { return l.sampled_below.low; });
}

/// "a move of 30 counts needs about 1 s"; nothing where no move is a step.
optional<string> arrival_text(const Approach& approach) {
  if (approach.longest_step == 0) return {};
  return fmt::format("a move of {} count{} needs about {:.2g} s", approach.longest_step,
                     approach.longest_step == 1 ? "" : "s", approach.longest_time);
}

Description<Approach> approach_description() {
  Description<Approach> description;
  add_range(description, "time_constant", "slowest time constant", "slowest time constant of the loop",
            &Approach::time_constant, "s");
  return description
      .value(everywhere("hold", "hold", "time that the shortest move is held", "s"), &Approach::hold)
      .value(everywhere("longest_step", "slowest move", "length of the slowest move; 0: no step", "count"),
             &Approach::longest_step)
      .value(
          everywhere("longest_time", "time of the slowest move", "time that it needs, with the dwell", "s"),
          &Approach::longest_time)
      .value(everywhere("exceeds_hold", "moves may end before they arrive",
                        "whether moves may end before they arrive"),
             &Approach::exceeds_hold);
}

}  // namespace

string slowness_text(const Approach& approach) {
  const string arrival = arrival_text(approach).value_or("");
  const double slowest = approach.time_constant.high;
  if (slowest > approach.hold) {
    return fmt::format(", {:.3g} s, exceeds the hold of {:.4g} s{}{}", slowest, approach.hold,
                       arrival.empty() ? "" : "; ", arrival);
  }
  return fmt::format(" is {:.3g} s; {}, longer than the hold of {:.4g} s", slowest, arrival, approach.hold);
}

string stability_text(const LoopRanges& loop) {
  const std::set<LoopStability>& stability = loop.stability;
  if (stability == std::set{LoopStability::stable}) {
    if (loop.slow.empty()) return "stable";
    return fmt::format("stable, with a time constant of {} s, longer than the hold", range_text(loop.slow));
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
      .shown_as(stability_text);
  add_range(description, "slow", "slowest time constant", "slowest time constants longer than the hold",
            &LoopRanges::slow, "s");
  add_range(description, "bandwidth", "crosses gain 1 at", "bandwidth while it slides",
            &LoopRanges::bandwidth, "Hz");
  add_range(description, "gain_margin", "gain margin", "gain margin", &LoopRanges::gain, "dB");
  add_range(description, "gain_margin_at", "at", "frequency of the gain margin", &LoopRanges::gain_at, "Hz");
  add_range(description, "phase_margin", "phase margin", "phase margin", &LoopRanges::phase, "°");
  add_range(description, "phase_margin_at", "at", "frequency of the phase margin", &LoopRanges::phase_at,
            "Hz");
  return description;
}

Description<PointTheory> point_theory_description() {
  using Of = const PointTheory&;
  const auto applies = [](Of theory) { return theory.outside.empty(); };
  return Description<PointTheory>()
      .value(
          everywhere("outside", "the criteria do not apply", "why (6) and (7) do not apply; null: they do"),
          [=](Of t) { return applies(t) ? std::nullopt : optional(t.outside); })
      .include(gain_description(), [=](Of t) { return applies(t) || t.free ? &t.gain : nullptr; })
      .include(rules_description(), [=](Of t) { return applies(t) ? &t.rules : nullptr; })
      .include(lowest_description(), [=](Of t) { return applies(t) ? &t.lowest : nullptr; })
      .include(approach_description(),
               [=](Of t) {
                 return (applies(t) || t.free) && !t.approach.time_constant.empty() ? &t.approach : nullptr;
               })
      .table(in_data("loops", "the loop at k1, at k1 + k2 and while the rotor slides"), loop_description(),
             &PointTheory::loops);
}

}  // namespace zerocount::theory
