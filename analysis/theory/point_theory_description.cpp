#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/theory/point_theory.hpp"

namespace zerocount::theory {
namespace {

using document::Description;
using document::in_data;
using document::Item;
using document::Shown;
using std::optional;
using std::string;

string range_text(const Range& range) {
  if (range.low == range.high) return fmt::format("{:.3g}", range.low);
  return fmt::format("{:.3g} … {:.3g}", range.low, range.high);
}

/// The item of a statement for people beside data.
Item statement(string key, string heading, string unit = {}) {
  return {.key = std::move(key),
          .heading = std::move(heading),
          .unit = std::move(unit),
          .shown = Shown::to_people};
}

/// A range as data.
template <class Row, class Get>
void add_range_data(Description<Row>& description, const Item& item, Get get) {
  description.object(in_data(item.key, item.meaning + ", over the trials", item.unit),
                     Description<Range>()
                         .value(in_data("low", "smallest", item.unit), &Range::low)
                         .value(in_data("high", "largest", item.unit), &Range::high),
                     [get](const Row& row) {
                       const Range& range = std::invoke(get, row);
                       return range.empty() ? nullptr : &range;
                     });
}

/// A range as data, and as a statement; nothing where it is empty.
template <class Row, class Get>
void add_range(Description<Row>& description, const Item& item, Get get) {
  add_range_data(description, item, get);
  description.value(statement(item.key + "_text", item.heading, item.unit),
                    [get](const Row& row) -> optional<string> {
                      const Range& range = std::invoke(get, row);
                      if (range.empty()) return {};
                      return range_text(range);
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

/// A margin with its frequency, as data and as a statement.
/// @param none the statement where no trial has a crossover
void add_margin(Description<LoopRanges>& description, const Item& margin, Range LoopRanges::*value,
                Range LoopRanges::*frequency, const char* none) {
  add_range_data(description, margin, value);
  add_range_data(description, in_data(margin.key + "_at", "frequency of the " + margin.meaning, "Hz"),
                 frequency);
  description.value(statement(margin.key + "_text", margin.heading), [=](const LoopRanges& loop) -> string {
    if ((loop.*value).empty()) return none;
    return fmt::format("{}{}{} at {} Hz", range_text(loop.*value), margin.unit == "°" ? "" : " ", margin.unit,
                       range_text(loop.*frequency));
  });
}

Description<GainTheory> gain_description() {
  using Of = const GainTheory&;
  const auto is_zero = [](Of gain) { return gain.value.low == 0.0 && gain.value.high == 0.0; };
  Description<GainTheory> description;
  description.value(in_data("gain_name", "name of the integral gain"), &GainTheory::name)
      .value(in_data("gain_unit", "unit of the gain and its bounds"), &GainTheory::unit);
  const auto add_gain = [&](const Item& item, Range GainTheory::*range) {
    add_range_data(description, item, range);
    description.value(statement(item.key + "_text", item.heading), [=](Of gain) -> optional<string> {
      if ((gain.*range).empty() || (!gain.left_out.empty() && item.heading.starts_with('('))) return {};
      return range_text(gain.*range) + " " + gain.unit;
    });
  };
  add_gain({"gain", "integral gain", "integral gain"}, &GainTheory::value);
  description
      .value({"integral", "integral", "why there is no integral; null: there is one"},
             [=](Of gain) -> optional<string> {
               if (!is_zero(gain)) return {};
               return gain.observes ? "none: the disturbance observer takes its place"
                                    : "none: the error stays wherever friction holds the rest of the torque";
             })
      .value({"criteria", "by (6) and (7)", "verdict of the paper's criteria (6) and (7)"},
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
      .value({"sampled", "sampled loop", "verdict of the sampled loop at k1, or without a spring"},
             [=](Of gain) -> optional<string> {
               if (is_zero(gain)) return {};
               if (gain.sampled_stable == std::set{true}) return "stable";
               return gain.sampled_stable == std::set{false} ? "unstable" : "unstable in some trials";
             });
  add_gain({"stable_below", "(6) stable below", "bound of criterion (6)"}, &GainTheory::stable_below);
  add_gain({"sampled_below", "sampled loop, stable below", "bound of the sampled loop"},
           &GainTheory::sampled_below);
  add_gain({"unstable_above", "(7) unstable above", "bound of criterion (7)"}, &GainTheory::unstable_above);
  return description;
}

/// "holds", "holds in 3 of 200 trials", "holds in no trial".
string holds_text(std::int64_t holding, std::int64_t trials) {
  if (holding == trials) return "holds";
  return holding == 0 ? "holds in no trial" : fmt::format("holds in {} of {} trials", holding, trials);
}

Description<DesignRules> rules_description() {
  using Of = const DesignRules&;
  Description<DesignRules> description;
  add_range_data(description, {.key = "dac_resolution", .meaning = "torque of a code of the DAC"},
                 &DesignRules::dac_resolution);
  add_range_data(description, {.key = "dac_bound", .meaning = "bound of the rule for the DAC"},
                 &DesignRules::dac_bound);
  description.value(in_data("torque_unit", "unit of both"), &DesignRules::torque_unit)
      .value(in_data("coarse_feedback", "whether the bound is of the coarse encoder"),
             &DesignRules::coarse_feedback)
      .value(in_data("rule_trials", "trials that the rules were tried in"), &DesignRules::trials)
      .value(in_data("fine_enough", "trials in which the DAC satisfies its rule"), &DesignRules::fine_enough)
      .value(in_data("fast_enough", "trials in which the sample rate satisfies its rule"),
             &DesignRules::fast_enough)
      .value(statement("dac_text", "DAC resolution"), [](Of rules) {
        return fmt::format("{} {}, below k1·Δx = {} {}{} (paper, issue 4): {}",
                           range_text(rules.dac_resolution), rules.torque_unit, range_text(rules.dac_bound),
                           rules.torque_unit,
                           rules.coarse_feedback ? " with the Δx of the coarse encoder" : "",
                           holds_text(rules.fine_enough, rules.trials));
      });
  add_range(description, {"natural_frequency", "natural frequency", "natural frequency on k1 + k2", "Hz"},
            &DesignRules::frequency);
  add_range_data(description, in_data("sample_rate", "sample rate", "Hz"), &DesignRules::sample_rate);
  return description.value(statement("sample_rate_text", "sample rate"), [](Of rules) {
    return fmt::format("{} Hz, at least {:.3g} times the natural frequency (paper: 10): {}",
                       range_text(rules.sample_rate), rules.sample_rate.low / rules.frequency.high,
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
  if (lowest.rigs == 0) return "the lowest along the profiles";
  return fmt::format("the lowest along the profiles of {} rigs", lowest.rigs);
}

Description<PointTheory> lowest_description() {
  using Of = const PointTheory&;
  return Description<PointTheory>()
      .value(in_data("lowest_k1", "lowest stiffness k1 of the study"), [](Of t) { return t.lowest.k1.low; })
      .value(in_data("lowest_k1_source", "where it is from"), [](Of t) { return source_text(t.lowest); })
      .value(statement("lowest_k1_text", "lowest k1"),
             [](Of t) { return fmt::format("{:.3g}, {}", t.lowest.k1.low, source_text(t.lowest)); })
      .value(in_data("lowest_stable_below", "bound of criterion (6) there, in the unit of the gain"),
             [](Of t) { return t.lowest.stable_below.low; })
      .value(in_data("lowest_sampled_below", "bound of the sampled loop there, in the unit of the gain"),
             [](Of t) { return t.lowest.sampled_below.low; })
      .value(statement("lowest_stable_below_text", "at the lowest k1: (6) stable below"),
             [](Of t) -> optional<string> {
               if (!t.gain.left_out.empty()) return {};
               return fmt::format("{:.3g} {}", t.lowest.stable_below.low, t.gain.unit);
             })
      .value(statement("lowest_sampled_below_text", "at the lowest k1: sampled loop below"),
             [](Of t) { return fmt::format("{:.3g} {}", t.lowest.sampled_below.low, t.gain.unit); });
}

/// "a move of 30 counts needs about 1 s"; nothing where no move is a step.
optional<string> arrival_text(const Approach& approach) {
  if (approach.longest_step == 0) return {};
  return fmt::format("a move of {} count{} needs about {:.2g} s", approach.longest_step,
                     approach.longest_step == 1 ? "" : "s", approach.longest_time);
}

Description<Approach> approach_description() {
  using Of = const Approach&;
  Description<Approach> description;
  add_range(description, {"time_constant", "slowest time constant", "slowest time constant of the loop", "s"},
            &Approach::time_constant);
  return description.value({"hold", "hold", "time that the shortest move is held", "s"}, &Approach::hold)
      .value(in_data("longest_step", "length of the slowest move; 0: no step", "count"),
             &Approach::longest_step)
      .value(in_data("longest_time", "time that it needs, with the dwell", "s"), &Approach::longest_time)
      .value(in_data("exceeds_hold", "whether moves may end before they arrive"), &Approach::exceeds_hold)
      .value(statement("slowest_move", "slowest move"), arrival_text)
      .value(statement("warning", "warning"), [](Of approach) -> optional<string> {
        if (!approach.exceeds_hold()) return {};
        return "moves may end before they arrive";
      });
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
  description.value({"loop", "loop", "where the rotor is"}, &LoopRanges::name)
      .value(in_data("slides", "whether the rotor slides"), &LoopRanges::slides)
      .value(in_data("stability", "stable, marginal or unstable: all that occur in the trials"), stabilities)
      .value(statement("stability_text", "verdict"), stability_text);
  add_range_data(description, in_data("slow", "slowest time constants longer than the hold", "s"),
                 &LoopRanges::slow);
  add_range(description, {"bandwidth", "crosses gain 1 at", "bandwidth while it slides", "Hz"},
            &LoopRanges::bandwidth);
  add_margin(description, {"gain_margin", "gain margin", "gain margin", "dB"}, &LoopRanges::gain,
             &LoopRanges::gain_at, "no phase crossover");
  add_margin(description, {"phase_margin", "phase margin", "phase margin", "°"}, &LoopRanges::phase,
             &LoopRanges::phase_at, "no gain crossover");
  return description;
}

Description<PointTheory> point_theory_description() {
  using Of = const PointTheory&;
  const auto applies = [](Of theory) { return theory.outside.empty(); };
  return Description<PointTheory>()
      .value({"outside", "the criteria do not apply", "why (6) and (7) do not apply; null: they do"},
             [=](Of t) { return applies(t) ? std::nullopt : optional(t.outside); })
      .include(gain_description(), [=](Of t) { return applies(t) || t.free ? &t.gain : nullptr; })
      .include(rules_description(), [=](Of t) { return applies(t) ? &t.rules : nullptr; })
      .include(lowest_description(), [=](Of t) { return applies(t) ? &t : nullptr; })
      .include(approach_description(),
               [=](Of t) {
                 return (applies(t) || t.free) && !t.approach.time_constant.empty() ? &t.approach : nullptr;
               })
      .table(in_data("loops", "the loop at k1, at k1 + k2 and while the rotor slides"), loop_description(),
             &PointTheory::loops);
}

}  // namespace zerocount::theory
