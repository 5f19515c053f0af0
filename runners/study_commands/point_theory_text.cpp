#include "runners/study_commands/point_theory_text.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/text/text.hpp"

namespace zerocount::study_commands {
namespace {

using theory::PointTheory;
using theory::Range;
using Items = std::vector<TheoryItem>;

std::string text(const Range& range) {
  if (range.low == range.high) return fmt::format("{:.3g}", range.low);
  return fmt::format("{:.3g} … {:.3g}", range.low, range.high);
}

std::string stability_text(const theory::LoopRanges& loop) {
  using theory::LoopStability;
  const std::set<LoopStability>& stability = loop.stability;
  if (stability == std::set{LoopStability::stable}) {
    if (loop.slow.empty()) return "stable";
    return fmt::format("stable, with a time constant of {} s, longer than the hold", text(loop.slow));
  }
  if (stability == std::set{LoopStability::unstable}) return "unstable";
  if (stability.count(LoopStability::unstable) > 0) return "unstable in some trials";
  return stability.count(LoopStability::stable) > 0
             ? "stable; in some trials marginal: a motion neither grows nor dies out within the hold"
             : "marginal: a motion neither grows nor dies out within the hold";
}

void add_loops(Items& items, const std::vector<theory::LoopRanges>& loops) {
  for (const theory::LoopRanges& loop : loops) {
    const auto add = [&](std::string_view what, std::string value, std::string brief = {}) {
      items.push_back({fmt::format("{}: {}", loop.name, what), std::move(value), std::move(brief)});
    };
    add("loop", stability_text(loop));
    if (!loop.bandwidth.empty()) add("crosses gain 1", fmt::format("at {} Hz", text(loop.bandwidth)));
    if (loop.gain.empty()) add("gain margin", "no phase crossover");
    if (!loop.gain.empty()) {
      add("gain margin", fmt::format("{} dB at {} Hz", text(loop.gain), text(loop.gain_at)),
          text(loop.gain) + " dB");
    }
    if (loop.phase.empty()) add("phase margin", "no gain crossover");
    if (!loop.phase.empty()) {
      add("phase margin", fmt::format("{}° at {} Hz", text(loop.phase), text(loop.phase_at)),
          text(loop.phase) + "°");
    }
  }
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

void add_lowest(Items& items, const theory::LowestStiffness& lowest, const theory::GainTheory& gain) {
  items.push_back({"lowest k1", fmt::format("{:.3g}, {}", lowest.k1.low, source_text(lowest))});
  if (gain.left_out.empty()) {
    items.push_back(
        {"at the lowest k1: (6) stable below", fmt::format("{:.3g} {}", lowest.stable_below.low, gain.unit)});
  }
  items.push_back({"at the lowest k1: sampled loop below",
                   fmt::format("{:.3g} {}", lowest.sampled_below.low, gain.unit)});
}

/// "a move of 30 counts needs about 1 s"; empty where no move is a step.
std::string arrival_text(const theory::Approach& approach) {
  if (approach.longest_step == 0) return {};
  return fmt::format("a move of {} needs about {:.2g} s", counted(approach.longest_step, "count"),
                     approach.longest_time);
}

/// Nothing if no loop is stable.
void add_approach(Items& items, const theory::Approach& approach) {
  if (approach.time_constant.empty()) return;
  const std::string arrival = arrival_text(approach);
  items.push_back({"slowest time constant", text(approach.time_constant) + " s"});
  items.push_back({"hold", fmt::format("{:.4g} s", approach.hold)});
  if (approach.longest_step != 0) items.push_back({"slowest move", arrival_text(approach)});
  if (approach.exceeds_hold()) items.push_back({"warning", "moves may end before they arrive"});
}

void add_range(Items& items, std::string name, const Range& range, std::string_view unit) {
  items.push_back({std::move(name), fmt::format("{} {}", text(range), unit)});
}

/// Verdict of the sampled loop on the integral gain.
std::string sampled_verdict(const theory::GainTheory& gain) {
  if (gain.sampled_stable == std::set{true}) return "stable";
  return gain.sampled_stable == std::set{false} ? "unstable" : "unstable in some trials";
}

/// Why a predicted cycle is rough; empty if it is not.
std::string roughness_text(const theory::LimitCycle& cycle, const theory::HuntingPrediction& hunting) {
  switch (theory::roughness_of(cycle, hunting)) {
    case theory::Roughness::none:
      return "";
    case theory::Roughness::few_counts:
      return ", roughly (few counts)";
    case theory::Roughness::few_samples:
      return fmt::format(", roughly ({:.2g} samples a period)", cycle.period / hunting.sample_time);
    case theory::Roughness::bristle:
      break;
  }
  return fmt::format(", within a third (before it slides, the bristle yields by {:.3g} counts and more)",
                     hunting.range / hunting.count_angle);
}

void add_cycles(Items& items, std::string_view method, const std::vector<theory::LimitCycle>& cycles,
                const theory::HuntingPrediction& hunting) {
  const std::string name = fmt::format("hunting of trial 0, {}", method);
  for (const theory::LimitCycle& cycle : cycles) {
    items.push_back({name, fmt::format("amplitude {:.4g} counts, period {:.4g} s{}",
                                       cycle.amplitude / hunting.count_angle, cycle.period,
                                       roughness_text(cycle, hunting))});
  }
  if (!cycles.empty()) return;
  items.push_back({name, hunting.grows_while_sliding
                             ? "no lasting cycle; the loop is unstable while the rotor slides: "
                               "what has broken loose may grow"
                             : "no lasting cycle"});
}

void add_hunting(Items& items, const theory::HuntingPrediction& hunting) {
  if (!hunting.left_out.empty()) {
    items.push_back({"hunting of trial 0",
                     fmt::format("not predicted, since the predictions leave out {}", hunting.left_out)});
    return;
  }
  // A cycle that one method finds is there: each leaves out cycles that the other has.
  const bool stick_slip_alone = hunting.by_function.empty() && !hunting.by_stick_slip.empty();
  const bool function_alone = hunting.by_stick_slip.empty() && !hunting.by_function.empty();
  if (!stick_slip_alone) add_cycles(items, "by describing function", hunting.by_function, hunting);
  if (hunting.sticks && !function_alone) add_cycles(items, "by stick-slip", hunting.by_stick_slip, hunting);
}

Items items_outside(const PointTheory& theory) {
  Items items;
  items.push_back({"the criteria do not apply", std::string(theory.outside)});
  if (theory.hunting) add_hunting(items, *theory.hunting);
  const theory::GainTheory& gain = theory.gain;
  if (theory.free) {
    add_range(items, gain.name, gain.value, gain.unit);
    items.push_back({"sampled loop", sampled_verdict(gain)});
    add_range(items, "sampled loop, below", gain.sampled_below, gain.unit);
    add_approach(items, theory.approach);
  }
  add_loops(items, theory.loops);
  return items;
}

/// Verdicts of the criteria (6) and (7) and of the sampled loop on the integral gain.
void add_gain(Items& items, const theory::GainTheory& gain) {
  add_range(items, gain.name, gain.value, gain.unit);
  const bool applies = gain.left_out.empty();
  if (gain.value.low == 0.0 && gain.value.high == 0.0) {
    items.push_back({"integral", gain.observes ? "none: the disturbance observer takes its place"
                                               : "none: the error stays wherever friction holds the rest of "
                                                 "the torque"});
  } else {
    items.push_back(
        {"by (6) and (7)", applies ? theory::verdict(gain.prediction)
                                   : fmt::format("do not apply, since they leave out {}", gain.left_out)});
    items.push_back({"sampled loop at k1", sampled_verdict(gain)});
  }
  if (applies) add_range(items, "(6) stable below", gain.stable_below, gain.unit);
  add_range(items, "sampled loop at k1, below", gain.sampled_below, gain.unit);
  if (applies) add_range(items, "(7) unstable above", gain.unstable_above, gain.unit);
}

/// "holds", "holds in 3 of 200 trials", "holds in no trial".
std::string holds_text(std::int64_t holding, std::int64_t trials) {
  if (holding == trials) return "holds";
  return holding == 0 ? "holds in no trial" : fmt::format("holds in {} of {} trials", holding, trials);
}

void add_rules(Items& items, const theory::DesignRules& rules) {
  items.push_back(
      {"DAC resolution",
       fmt::format("{} {}, below k1·Δx = {} {}{} (paper, issue 4): {}", text(rules.dac_resolution),
                   rules.torque_unit, text(rules.dac_bound), rules.torque_unit,
                   rules.coarse_feedback ? " with the Δx of the coarse encoder" : "",
                   holds_text(rules.fine_enough, rules.trials))});
  items.push_back({"natural frequency", text(rules.frequency) + " Hz"});
  items.push_back(
      {"sample rate", fmt::format("{} Hz, at least {:.3g} times the natural frequency (paper: 10): {}",
                                  text(rules.sample_rate), rules.sample_rate.low / rules.frequency.high,
                                  holds_text(rules.fast_enough, rules.trials))});
}

/// A line per item.
std::string list_of(std::span<const TheoryItem> items) {
  std::size_t width = 0;
  for (const TheoryItem& item : items) width = std::max(width, text::display_width(item.name));
  std::string lines;
  for (const TheoryItem& item : items) {
    const std::string padding(width - text::display_width(item.name), ' ');
    lines += fmt::format("  {}{}  {}\n", item.name, padding, item.value);
  }
  return lines;
}

/// The names of all items, each once, in the order in which points have them.
std::vector<std::string> names_in(std::span<const std::vector<TheoryItem>> items) {
  std::vector<std::string> names;
  for (const std::vector<TheoryItem>& of_point : items) {
    auto place = names.begin();
    for (const TheoryItem& item : of_point) {
      const auto found = std::ranges::find(names, item.name);
      place = found != names.end() ? found + 1 : names.insert(place, item.name) + 1;
    }
  }
  return names;
}

/// The statement of this name, of several their values in one; "–" if there is none.
TheoryItem value_of(std::span<const TheoryItem> items, const std::string& name) {
  TheoryItem found{name, "", ""};
  for (const TheoryItem& item : items) {
    if (item.name != name) continue;
    found.value += (found.value.empty() ? "" : "; ") + item.value;
    found.brief = item.brief;
  }
  if (found.value.empty()) found.value = "–";
  return found;
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

std::vector<TheoryItem> theory_items(const PointTheory& theory) {
  if (!theory.outside.empty()) return items_outside(theory);
  Items items;
  add_gain(items, theory.gain);
  add_rules(items, theory.rules);
  add_lowest(items, theory.lowest, theory.gain);
  add_approach(items, theory.approach);
  add_loops(items, theory.loops);
  return items;
}

std::string theory_text(std::span<const std::string> labels, std::span<const std::vector<TheoryItem>> items,
                        std::int64_t points) {
  if (items.size() == 1) return list_of(items.front());
  std::vector<TheoryItem> common;
  std::vector<text::TextColumn> columns{{"point", false, {labels.begin(), labels.end()}}};
  for (const std::string& name : names_in(items)) {
    std::vector<TheoryItem> of_points;
    for (const std::vector<TheoryItem>& of_point : items) of_points.push_back(value_of(of_point, name));
    const bool same = std::ranges::all_of(
        of_points, [&](const TheoryItem& item) { return item.value == of_points.front().value; });
    if (same) {
      common.push_back(of_points.front());
      continue;
    }
    text::TextColumn& column = columns.emplace_back(text::TextColumn{name, false, {}});
    for (const TheoryItem& item : of_points)
      column.cells.push_back(item.brief.empty() ? item.value : item.brief);
  }
  const std::string where = std::ssize(items) == points
                                ? "at all points"
                                : fmt::format("at each of the first {} of {} points", items.size(), points);
  std::string text = common.empty() ? "" : fmt::format("{}:\n{}", where, list_of(common));
  if (columns.size() > 1) text += "\n" + text::aligned_table(columns);
  return text;
}

}  // namespace zerocount::study_commands
