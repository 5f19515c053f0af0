#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/text/text.hpp"
#include "experiments/parameters/study_units.hpp"
#include "runners/design_commands/tune_parts.hpp"
#include "runners/design_commands/worst_command.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::in_data;
using document::Shown;
using text::short_number;
using tuning::CriticalLoop;
using tuning::NearestPoint;
using tuning::SmallestMargins;
using tuning::TuneAnswer;

struct NamedMargin {
  std::string_view name;
  std::string_view unit;
  double found;
  std::optional<double> wanted;
};

std::vector<NamedMargin> margins_beside(const SmallestMargins& found, const study::LoopMargins& wanted) {
  return {{"gain", "dB", found.gain, wanted.gain},
          {"phase", "degrees", found.phase, wanted.phase},
          {"delay", "samples", found.delay, wanted.delay}};
}

/// "gain margin 7.2 dB (at least 6 wanted), phase margin …".
std::string margins_text(const SmallestMargins& found, const study::LoopMargins& wanted) {
  constexpr double longest_delay = 10.0;
  std::vector<std::string> texts;
  for (const NamedMargin& one : margins_beside(found, wanted)) {
    const bool is_longest = one.name == "delay" && one.found >= longest_delay;
    texts.push_back(fmt::format(
        "{} margin {} {}{} ({})", one.name, std::isfinite(one.found) ? short_number(one.found) : "∞",
        one.unit, is_longest ? " or more" : "",
        one.wanted ? fmt::format("at least {:g} wanted", *one.wanted) : std::string("none wanted")));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// The loops that were examined.
std::string_view loops_text(const SmallestMargins& margins) {
  if (!margins.sliding) return " before they slide";
  return margins.before_sliding ? " before they slide and while they slide" : " while they slide";
}

std::string margins_sentence(Of tuning) {
  const TuneAnswer& answer = tuning.answer;
  if (answer.blind)
    return "margins: none, because the controller is a plugin, whose transfer function is not known";
  if (!answer.margins) return "";
  const study::LoopMargins& wanted = tuning.study.tuning->margins;
  std::string text =
      fmt::format("smallest margins of {} machines{}: {}{}", answer.margins->machines,
                  loops_text(*answer.margins), margins_text(*answer.margins, wanted),
                  answer.margins->stable ? "" : "\n  the linear loop of a machine is unstable");
  for (std::size_t condition = 0; condition < answer.margins->conditions.size(); ++condition) {
    text += fmt::format("\n  under condition {}: {}", tuning.study.conditions[condition],
                        margins_text(answer.margins->conditions[condition], wanted));
  }
  return text;
}

/// "before sliding at 1560 N m/rad of machine 31 under condition loaded".
std::string loop_text(const CriticalLoop& loop, const study::Study& study) {
  return loop.name +
         (loop.stiffness ? fmt::format(" at {} {}", short_number(*loop.stiffness),
                                       parameters::unit_on(study.units.axis, "N m/rad"))
                         : std::string()) +
         (loop.machine ? fmt::format(" of machine {}", *loop.machine) : std::string()) +
         study::condition_text(study, loop.condition);
}

/// The loops in which the margins are the smallest.
std::string critical_loops_sentence(Of tuning) {
  if (!tuning.answer.margins) return "";
  const SmallestMargins& margins = *tuning.answer.margins;
  std::vector<std::string> texts;
  for (const auto& [name, loop] :
       {std::pair("gain", &margins.gain_loop), std::pair("phase", &margins.phase_loop),
        std::pair("delay", &margins.delay_loop)}) {
    if (*loop) texts.push_back(fmt::format("{} {}", name, loop_text(**loop, tuning.study)));
  }
  return texts.empty() ? "" : fmt::format("  found in the loops: {}", fmt::join(texts, "; "));
}

struct LoopReading {
  const CriticalLoop& loop;
  const study::Study& study;
};

Description<LoopReading> loop_description() {
  using Reading = const LoopReading&;
  return Description<LoopReading>()
      .value(in_data("loop", "the loop in words"), [](Reading r) { return r.loop.name; })
      .value(
          in_data("stiffness",
                  "of the contact before it slides, N m/rad (N/m on a linear axis); unknown while sliding"),
          [](Reading r) { return r.loop.stiffness; })
      .value(in_data("machine", "number of the machine; unknown where the stiffness says all of it"),
             [](Reading r) { return r.loop.machine; })
      .value({.key = "condition",
              .meaning = "the condition that it bears, with conditions",
              .shown = Shown::in_data,
              .optional = true},
             [](Reading r) {
               return tuning::condition_name(r.study, {0, static_cast<std::size_t>(r.loop.condition)});
             });
}

struct ConditionMargins {
  std::string condition;
  const SmallestMargins& margins;
};

std::vector<ConditionMargins> margins_of_conditions(Of tuning) {
  std::vector<ConditionMargins> rows;
  if (!tuning.answer.margins) return rows;
  for (std::size_t i = 0; i < tuning.answer.margins->conditions.size(); ++i)
    rows.push_back({tuning.study.conditions[i], tuning.answer.margins->conditions[i]});
  return rows;
}

Description<SmallestMargins> margins_description() {
  return Description<SmallestMargins>()
      .value(in_data("gain", "gain margin; unknown where no loop has a limit", "dB"), &SmallestMargins::gain)
      .value(in_data("phase", "phase margin; unknown where no loop has a limit", "degrees"),
             &SmallestMargins::phase)
      .value(in_data("delay", "samples of delay until a loop is unstable; 10 means 10 or more", "samples"),
             &SmallestMargins::delay)
      .value(in_data("stable", "whether no loop is unstable"), &SmallestMargins::stable)
      .value(in_data("machines", "machines that were examined"), &SmallestMargins::machines);
}

/// The margins that the nearest point lacks, and by how much.
std::vector<NamedMargin> lacking(const NearestPoint& nearest, const study::LoopMargins& wanted) {
  if (!nearest.margins.stable) return {};
  std::vector<NamedMargin> lacking = margins_beside(nearest.margins, wanted);
  std::erase_if(lacking, [](const NamedMargin& one) { return !one.wanted || one.found >= *one.wanted; });
  return lacking;
}

std::string nearest_sentence(Of tuning) {
  if (!tuning.answer.nearest) return "";
  const NearestPoint& nearest = *tuning.answer.nearest;
  const std::string at = values_text(named(tuning.answer.free, nearest.values));
  if (!nearest.margins.stable) {
    return fmt::format(
        "the loop of a machine is unstable at all of them; nearest, at {}, by {} of gain", at,
        std::isfinite(nearest.margins.gain) ? short_number(nearest.margins.gain) + " dB" : "any factor");
  }
  const study::LoopMargins& wanted = tuning.study.tuning->margins;
  std::string lines = fmt::format("nearest: {}, with {}\n", at, margins_text(nearest.margins, wanted));
  for (const NamedMargin& one : lacking(nearest, wanted))
    lines += fmt::format("  its {} margin is {} {} too small\n", one.name,
                         short_number(*one.wanted - one.found), one.unit);
  return lines;
}

struct NearestReading {
  const NearestPoint& nearest;
  Of tuning;
};

Description<NearestReading> nearest_description() {
  using Reading = const NearestReading&;
  return Description<NearestReading>()
      .value(in_data("gains", "its values, by parameter"),
             [](Reading r) { return named(r.tuning.answer.free, r.nearest.values); })
      .object(in_data("margins", "its smallest margins"), margins_description(),
              [](Reading r) { return r.nearest.margins; })
      .value(in_data("lacking", "by how much margins are too small: dB, degrees, samples"), [](Reading r) {
        NamedValues amounts;
        for (const NamedMargin& one : lacking(r.nearest, r.tuning.study.tuning->margins))
          amounts.emplace_back(one.name, *one.wanted - one.found);
        return amounts;
      });
}

}  // namespace

void add_margins(Description<Tuning>& items) {
  items.sentence(margins_sentence).sentence(critical_loops_sentence);
  items.object(in_data("margins", "smallest margins of the tuned loops"), margins_description(),
               [](Of t) { return t.answer.margins; });
  const auto add_loop = [&](const std::string& margin, std::optional<CriticalLoop> SmallestMargins::*loop) {
    items.object(in_data(margin + "_margin_loop", "the loop that has the smallest " + margin + " margin"),
                 loop_description(), [loop](Of t) -> std::optional<LoopReading> {
                   if (!t.answer.margins || !((*t.answer.margins).*loop)) return {};
                   return LoopReading{*((*t.answer.margins).*loop), t.study};
                 });
  };
  add_loop("gain", &SmallestMargins::gain_loop);
  add_loop("phase", &SmallestMargins::phase_loop);
  add_loop("delay", &SmallestMargins::delay_loop);
  items.table({.key = "margins_by_condition",
               .meaning = "smallest margins under each condition, with conditions",
               .shown = Shown::in_data,
               .optional = true},
              Description<ConditionMargins>()
                  .value(in_data("condition", "its name"), &ConditionMargins::condition)
                  .include(margins_description(),
                           [](const ConditionMargins& row) -> const SmallestMargins& { return row.margins; }),
              margins_of_conditions);
}

void add_nearest(Description<Tuning>& items) {
  items.sentence(nearest_sentence)
      .object(in_data("nearest", "the point that comes nearest to the margins, where none keeps them"),
              nearest_description(), [](Of t) -> std::optional<NearestReading> {
                if (!t.answer.nearest) return {};
                return NearestReading{*t.answer.nearest, t};
              });
}

}  // namespace zerocount::design_commands
