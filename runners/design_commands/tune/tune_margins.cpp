#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "core/text/text.hpp"
#include "experiments/parameters/study_units.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::everywhere;
using document::in_data;
using document::Visibility;
using text::short_number;
using tuning::CriticalLoop;
using tuning::NearestPoint;
using tuning::SmallestMargins;

/// A kind of stability margin for which a user can set a limit, such as the phase margin.
struct Margin {
  std::string_view name;
  std::string_view title;
  std::string_view unit;
  std::string_view loop_key;  ///< Key, in JSON, of the loop that has the worst value of this margin.
  std::string_view meaning;
  tuning::Smallest SmallestMargins::*found;
  std::optional<double> study::LoopMargins::*wanted;
  bool is_upper{false};  ///< Whether the user's limit is an upper one, so that smaller values are better.
};

constexpr Margin all_margins[] = {
    {"gain", "gain margin", " dB", "gain_margin_loop", "gain margin; unknown where no loop has a limit",
     &SmallestMargins::gain, &study::LoopMargins::gain},
    {"phase", "phase margin", " degrees", "phase_margin_loop",
     "phase margin; unknown where no loop has a limit", &SmallestMargins::phase, &study::LoopMargins::phase},
    {"delay", "delay margin", " samples", "delay_margin_loop",
     "samples of delay until a loop is unstable; 10 means 10 or more", &SmallestMargins::delay,
     &study::LoopMargins::delay},
    {"sensitivity", "sensitivity", "", "sensitivity_loop", "largest |S|, S = 1/(1 + L)",
     &SmallestMargins::sensitivity, &study::LoopMargins::sensitivity, true}};

/// Text of a stability margin with its wanted limit: "7.2 dB (at least 6 wanted)", "10 samples or more (none
/// wanted)", "∞ dB".
std::string found_text(const Margin& margin, double found, const std::optional<double>& wanted) {
  return fmt::format(
      "{}{}{} ({})", std::isfinite(found) ? short_number(found) : "∞", margin.unit,
      margin.name == "delay" && found >= SmallestMargins::max_delay ? " or more" : "",
      wanted ? fmt::format("at {} {:g} wanted", margin.is_upper ? "most" : "least", *wanted) : "none wanted");
}

/// Text that names the control loop with the worst margin: "before sliding at 1560 N m/rad of machine 31
/// under condition loaded".
std::string loop_text(const CriticalLoop& loop, const study::Study& study) {
  return loop.name +
         (loop.stiffness ? fmt::format(" at {} {}", short_number(*loop.stiffness),
                                       parameters::unit_on(study.units.axis, "N m/rad"))
                         : std::string()) +
         (loop.machine ? fmt::format(" of machine {}", *loop.machine) : std::string()) +
         study::setting_phrase(study.settings, loop.setting);
}

/// A stability margin of the tuned loops, as a row of a table.
struct MarginRow {
  const Margin& margin;
  const SmallestMargins& margins;
  const study::Study& study;
};

std::vector<MarginRow> margin_rows(const Tuning& tuning) {
  std::vector<MarginRow> rows;
  if (!tuning.answer.tuned.margins) return rows;
  for (const Margin& one : all_margins) rows.push_back({one, *tuning.answer.tuned.margins, tuning.study});
  return rows;
}

Description<MarginRow> margin_columns() {
  return Description<MarginRow>()
      .value({.heading = "margin"}, [](const MarginRow& row) { return row.margin.title; })
      .value({.heading = "smallest"},
             [](const MarginRow& row) {
               return found_text(row.margin, (row.margins.*row.margin.found).value,
                                 row.study.tuning->margins.*row.margin.wanted);
             })
      .value({.heading = "in the loop"}, [](const MarginRow& row) {
        const std::optional<CriticalLoop>& loop = (row.margins.*row.margin.found).loop;
        return loop ? loop_text(*loop, row.study) : "";
      });
}

/// Sentence about the machines whose loops were examined: "of 100 machines of the search while they slide, at
/// ±10 % of inertia". A search examines its own machines. The answer for a finished proof examines the
/// machines of the proof, so that their numbers are the numbers in the file.
std::string examined_sentence(const Tuning& tuning) {
  if (tuning.answer.blind)
    return "margins: none, because the controller is a plugin, whose transfer function is not known";
  if (!tuning.answer.tuned.margins) return "";
  const SmallestMargins& margins = *tuning.answer.tuned.margins;
  std::vector<std::string> phases;
  if (margins.before_sliding) phases.emplace_back("before they slide");
  if (margins.sliding) phases.emplace_back("while they slide");
  std::string text = fmt::format("of {} of the {} {}", text::counted(margins.machines, "machine"),
                                 tuning.is_of_file ? "proof" : "search", fmt::join(phases, " and "));
  const study::LoopSpread& spread = margins.spread;
  for (const auto& [name, part] : {std::pair("inertia", spread.inertia), std::pair("damping", spread.damping),
                                   std::pair("torque constant", spread.torque_constant)}) {
    if (part) text += fmt::format(", at ±{:g} % of {}", 100.0 * *part, name);
  }
  return text + (margins.stable ? "" : "\nthe linear loop of a machine is unstable");
}

/// Sentence about the lowest frequency of a load mode (which the study lacks) that leaves the loops stable.
/// It warns if the loops' crossover frequency is more than a third of it. Empty if it is not known.
std::string mode_sentence(const Tuning& tuning) {
  const tuning::TuneAnswer& answer = tuning.answer;
  if (!answer.tuned.lowest_mode || !answer.tuned.margins || !(answer.tuned.margins->crossover > 0.0))
    return "";
  constexpr double crossover_of_mode = 1.0 / 3.0;
  const double crossover = answer.tuned.margins->crossover;
  return fmt::format(
      "a mode of half of the inertia, which the study lacks, leaves the loops stable if it is at {} Hz or "
      "higher; they cross over at {} Hz{}",
      short_number(*answer.tuned.lowest_mode), short_number(crossover),
      crossover > crossover_of_mode * *answer.tuned.lowest_mode
          ? ", more than a third of it: make sure that the axis has no mode that low"
          : "");
}

struct LoopOfStudy {
  const CriticalLoop& loop;
  const study::Study& study;
};

Description<LoopOfStudy> loop_description() {
  return Description<LoopOfStudy>()
      .value(in_data("loop", "the loop in words"), [](const LoopOfStudy& r) { return r.loop.name; })
      .value(
          in_data("stiffness",
                  "of the contact before it slides, N m/rad (N/m on a linear axis); unknown while sliding"),
          [](const LoopOfStudy& r) { return r.loop.stiffness; })
      .value(in_data("machine", "number of the machine; unknown where the stiffness says all of it"),
             [](const LoopOfStudy& r) { return r.loop.machine; })
      .value(optional(in_data("condition", "the condition under which it runs, in a study with conditions")),
             [](const LoopOfStudy& r) {
               return tuning::names_of(r.study, {0, static_cast<std::size_t>(r.loop.setting)}).setting;
             });
}

Description<SmallestMargins> margins_description() {
  Description<SmallestMargins> margins;
  for (const Margin& one : all_margins)
    margins.value(everywhere(std::string(one.name), std::string(one.title), std::string(one.meaning),
                             one.unit.empty() ? "1" : std::string(one.unit.substr(1))),
                  [found = one.found](const SmallestMargins& of) { return (of.*found).value; });
  return margins
      .value(in_data("crossover", "highest frequency at which |L| = 1; 0 without one", "Hz"),
             &SmallestMargins::crossover)
      .value(everywhere("stable", "stable", "whether no loop is unstable"), &SmallestMargins::stable)
      .value(in_data("machines", "machines that were examined"), &SmallestMargins::machines);
}

struct SettingMargins {
  std::string setting;
  const SmallestMargins& margins;
};

std::vector<SettingMargins> margins_of_settings(const Tuning& tuning) {
  std::vector<SettingMargins> rows;
  if (!tuning.answer.tuned.margins) return rows;
  for (std::size_t i = 0; i < tuning.answer.tuned.margins->settings.size(); ++i)
    rows.push_back({study::label_of(tuning.study.settings, i), tuning.answer.tuned.margins->settings[i]});
  return rows;
}

/// Names of the wanted margins that the examined point closest to them does not keep, each with the missing
/// amount in the unit of the margin. Empty if a loop is unstable.
NamedValues lacking_of(const NearestPoint& nearest, const study::LoopMargins& wanted) {
  NamedValues lacking;
  for (const Margin& one : all_margins) {
    const std::optional<double>& limit = wanted.*one.wanted;
    if (!nearest.margins.stable || !limit) continue;
    const double found = (nearest.margins.*one.found).value;
    const double lack = one.is_upper ? found - *limit : *limit - found;
    if (lack > 0.0) lacking.emplace_back(one.name, lack);
  }
  return lacking;
}

std::string nearest_sentence(const Tuning& tuning) {
  const std::optional<NearestPoint>& nearest = tuning.answer.unfound.nearest;
  if (!nearest || nearest->margins.stable) return "";
  const double gain = nearest->margins.gain.value;
  return "the loop of a machine is unstable at all of them; at the nearest " +
         (std::isfinite(gain) ? "by " + short_number(gain) + " dB of gain" : "no gain stabilises it");
}

Description<Tuning> nearest_description() {
  return Description<Tuning>()
      .value(everywhere("gains", "values", "its values, by parameter"),
             [](const Tuning& t) { return named(t.answer.free, t.answer.unfound.nearest->values); })
      .object({.key = "margins", .meaning = "its smallest margins"}, margins_description(),
              [](const Tuning& t) { return t.answer.unfound.nearest->margins; })
      .value(everywhere(
                 "lacking", "lacking",
                 "by how much margins are too small, or the sensitivity too large: dB, degrees, samples, 1"),
             [](const Tuning& t) { return lacking_of(*t.answer.unfound.nearest, t.study.tuning->margins); });
}

}  // namespace

void add_margin_table(Items& items) {
  items.table({.heading = "smallest margins", .shown = Visibility::to_people}, margin_columns(), margin_rows)
      .sentence(examined_sentence)
      .sentence(mode_sentence);
}

void add_margins(Items& items) {
  add_margin_table(items);
  items.object(in_data("margins", "smallest margins of the tuned loops"), margins_description(),
               [](const Tuning& t) { return t.answer.tuned.margins; });
  items.value(
      in_data(
          "lowest_mode",
          "frequency at and above which a mode of half of the inertia, which the study lacks, leaves the loops stable",
          "Hz"),
      [](const Tuning& t) { return t.answer.tuned.lowest_mode; });
  for (const Margin& one : all_margins) {
    items.object(in_data(std::string(one.loop_key), fmt::format("the loop that has the worst {}", one.title)),
                 loop_description(), [found = one.found](const Tuning& t) -> std::optional<LoopOfStudy> {
                   if (!t.answer.tuned.margins || !((*t.answer.tuned.margins).*found).loop) return {};
                   return LoopOfStudy{*((*t.answer.tuned.margins).*found).loop, t.study};
                 });
  }
  items.table(optional(everywhere("margins_by_condition", "smallest margins under each condition",
                                  "smallest margins under each condition, with conditions")),
              Description<SettingMargins>()
                  .value(everywhere("condition", "condition", "its name"), &SettingMargins::setting)
                  .include(margins_description(),
                           [](const SettingMargins& row) -> const SmallestMargins& { return row.margins; }),
              margins_of_settings);
}

void add_nearest(Items& items) {
  items.sentence(nearest_sentence)
      .object(everywhere("nearest", "nearest",
                         "the point that comes nearest to the margins, where none keeps them"),
              nearest_description(), [](const Tuning& t) { return t.answer.unfound.nearest ? &t : nullptr; });
}

}  // namespace zerocount::design_commands
