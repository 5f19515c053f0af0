#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/text/text.hpp"
#include "core/text/counted.hpp"
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
  std::optional<CriticalLoop> loop{};  ///< that has it
  bool is_upper{false};                ///< what is wanted is the largest value

  /// By how much it is short of what is wanted; 0 where it is not.
  double lack() const {
    if (!wanted) return 0.0;
    return std::max(is_upper ? found - *wanted : *wanted - found, 0.0);
  }
};

std::vector<NamedMargin> margins_beside(const SmallestMargins& found, const study::LoopMargins& wanted) {
  return {{"gain", "dB", found.gain, wanted.gain, found.gain_loop},
          {"phase", "degrees", found.phase, wanted.phase, found.phase_loop},
          {"delay", "samples", found.delay, wanted.delay, found.delay_loop},
          {"sensitivity", "1", found.sensitivity, wanted.sensitivity, found.sensitivity_loop, true}};
}

/// "gain margin", "sensitivity".
std::string title_of(const NamedMargin& margin) {
  return std::string(margin.name) + (margin.is_upper ? "" : " margin");
}

/// " dB"; nothing where there is no unit.
std::string unit_text(const NamedMargin& margin) {
  return margin.unit == "1" ? "" : fmt::format(" {}", margin.unit);
}

/// "7.2 dB", "10 samples or more", "∞ dB".
std::string found_text(const NamedMargin& margin) {
  constexpr double longest_delay = 10.0;
  return fmt::format("{}{}{}", std::isfinite(margin.found) ? short_number(margin.found) : "∞",
                     unit_text(margin),
                     margin.name == "delay" && margin.found >= longest_delay ? " or more" : "");
}

/// "at least 6 wanted", "none wanted".
std::string wanted_text(const NamedMargin& margin) {
  if (!margin.wanted) return "none wanted";
  return fmt::format("at {} {:g} wanted", margin.is_upper ? "most" : "least", *margin.wanted);
}

/// "gain margin 7.2 dB (at least 6 wanted), phase margin …".
std::string margins_text(const SmallestMargins& found, const study::LoopMargins& wanted) {
  std::vector<std::string> texts;
  for (const NamedMargin& one : margins_beside(found, wanted))
    texts.push_back(fmt::format("{} {} ({})", title_of(one), found_text(one), wanted_text(one)));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// "±10 % of inertia, ±30 % of damping": by which the machines differ beyond what the study draws.
std::string spread_text(const study::LoopSpread& spread) {
  std::vector<std::string> texts;
  for (const auto& [name, part] :
       {std::pair("inertia", &spread.inertia), std::pair("damping", &spread.damping),
        std::pair("torque constant", &spread.torque_constant)}) {
    if (*part) texts.push_back(fmt::format("±{:g} % of {}", 100.0 * **part, name));
  }
  return texts.empty() ? "" : fmt::format(", at {}", fmt::join(texts, ", "));
}

/// The loops that were examined.
std::string_view loops_text(const SmallestMargins& margins) {
  if (!margins.sliding) return " before they slide";
  return margins.before_sliding ? " before they slide and while they slide" : " while they slide";
}

/// "100 machines of the search": a search examines its own machines, and what is told of a finished proof
/// those of the proof, so that the numbers of the machines are those of the file.
std::string examined_machines(Of tuning) {
  return fmt::format("{} of the {}", text::counted(tuning.answer.margins->machines, "machine"),
                     tuning.is_of_file ? "proof" : "search");
}

std::string margins_sentence(Of tuning) {
  const TuneAnswer& answer = tuning.answer;
  if (answer.blind)
    return "margins: none, because the controller is a plugin, whose transfer function is not known";
  if (!answer.margins) return "";
  const study::LoopMargins& wanted = tuning.study.tuning->margins;
  std::string text =
      fmt::format("smallest margins of {}{}{}: {}{}", examined_machines(tuning), loops_text(*answer.margins),
                  spread_text(answer.margins->spread), margins_text(*answer.margins, wanted),
                  answer.margins->stable ? "" : "\n  the linear loop of a machine is unstable");
  for (std::size_t condition = 0; condition < answer.margins->conditions.size(); ++condition) {
    text +=
        fmt::format("\n {}: {}", study::condition_text(tuning.study, static_cast<std::int64_t>(condition)),
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
  std::vector<std::string> texts;
  for (const NamedMargin& one : margins_beside(*tuning.answer.margins, tuning.study.tuning->margins)) {
    if (one.loop) texts.push_back(fmt::format("{} {}", one.name, loop_text(*one.loop, tuning.study)));
  }
  return texts.empty() ? "" : fmt::format("  found in the loops: {}", fmt::join(texts, "; "));
}

/// The mode of a load that the loops bear, and a warning where they reach for it.
std::string mode_sentence(Of tuning) {
  const TuneAnswer& answer = tuning.answer;
  if (!answer.lowest_mode || !answer.margins || !(answer.margins->crossover > 0.0)) return "";
  constexpr double crossover_of_mode = 1.0 / 3.0;
  const double crossover = answer.margins->crossover;
  return fmt::format(
      "a mode of half of the inertia, which the study lacks, is borne from {} Hz on; the loops cross over at "
      "{} Hz{}",
      short_number(*answer.lowest_mode), short_number(crossover),
      crossover > crossover_of_mode * *answer.lowest_mode
          ? ", more than a third of it: make sure that the axis has no mode that low"
          : "");
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
      .value(in_data("sensitivity", "largest |S|, S = 1/(1 + L)", "1"), &SmallestMargins::sensitivity)
      .value(in_data("crossover", "highest frequency at which |L| = 1; 0 without one", "Hz"),
             &SmallestMargins::crossover)
      .value(in_data("stable", "whether no loop is unstable"), &SmallestMargins::stable)
      .value(in_data("machines", "machines that were examined"), &SmallestMargins::machines);
}

/// The margins that the nearest point lacks, and by how much.
std::vector<NamedMargin> lacking(const NearestPoint& nearest, const study::LoopMargins& wanted) {
  if (!nearest.margins.stable) return {};
  std::vector<NamedMargin> lacking = margins_beside(nearest.margins, wanted);
  std::erase_if(lacking, [](const NamedMargin& one) { return one.lack() == 0.0; });
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
    lines += fmt::format("  its {} is {}{} too {}\n", title_of(one), short_number(one.lack()), unit_text(one),
                         one.is_upper ? "large" : "small");
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
      .value(
          in_data("lacking",
                  "by how much margins are too small, or the sensitivity too large: dB, degrees, samples, 1"),
          [](Reading r) {
            NamedValues amounts;
            for (const NamedMargin& one : lacking(r.nearest, r.tuning.study.tuning->margins))
              amounts.emplace_back(one.name, one.lack());
            return amounts;
          });
}

}  // namespace

void add_margins(Description<Tuning>& items) {
  items.sentence(margins_sentence).sentence(critical_loops_sentence).sentence(mode_sentence);
  items.object(in_data("margins", "smallest margins of the tuned loops"), margins_description(),
               [](Of t) { return t.answer.margins; });
  items.value(
      in_data("lowest_mode",
              "frequency from which on the loops bear a mode of half of the inertia, which the study lacks",
              "Hz"),
      [](Of t) { return t.answer.lowest_mode; });
  const auto add_loop = [&](const std::string& margin, std::optional<CriticalLoop> SmallestMargins::*loop) {
    items.object(in_data(margin + "_loop", "the loop that has the worst " + margin), loop_description(),
                 [loop](Of t) -> std::optional<LoopReading> {
                   if (!t.answer.margins || !((*t.answer.margins).*loop)) return {};
                   return LoopReading{*((*t.answer.margins).*loop), t.study};
                 });
  };
  add_loop("gain_margin", &SmallestMargins::gain_loop);
  add_loop("phase_margin", &SmallestMargins::phase_loop);
  add_loop("delay_margin", &SmallestMargins::delay_loop);
  add_loop("sensitivity", &SmallestMargins::sensitivity_loop);
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

void add_margin_table(Description<Tuning>& items) {
  struct Row {
    std::string margin;
    std::string smallest;
    std::string loop;
  };
  items.table({},
              Description<Row>()
                  .value({.heading = "margin"}, &Row::margin)
                  .value({.heading = "smallest"}, &Row::smallest)
                  .value({.heading = "in the loop"}, &Row::loop),
              [](Of t) {
                std::vector<Row> rows;
                if (!t.answer.margins) return rows;
                for (const NamedMargin& one : margins_beside(*t.answer.margins, t.study.tuning->margins))
                  rows.push_back({title_of(one), fmt::format("{} ({})", found_text(one), wanted_text(one)),
                                  one.loop ? loop_text(*one.loop, t.study) : ""});
                return rows;
              });
  items.sentence([](Of t) { return t.answer.margins ? "of " + examined_machines(t) : std::string(); });
  items.sentence([](Of t) {
    return t.answer.margins && !t.answer.margins->stable ? "the linear loop of a machine is unstable" : "";
  });
  items.sentence(mode_sentence);
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
