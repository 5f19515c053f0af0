#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/goal/goal_text.hpp"
#include "analysis/statistics/spread_over.hpp"
#include "analysis/text/text.hpp"
#include "runners/design_commands/limits_command.hpp"
#include "runners/design_commands/tune_figures.hpp"
#include "runners/design_commands/tune_parts.hpp"
#include "runners/design_commands/worst_command.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::in_data;
using document::Notation;
using document::Shown;
using tuning::Alternative;
using tuning::TriedPoint;
using tuning::TuneAnswer;

std::string wider_band_sentence(Of tuning) {
  if (!tuning.answer.wider_band_rate) return "";
  const study::Goal& goal = worst_goal(tuning);
  return fmt::format("within ±{} counts {:.4g} % of the {} would meet the goal{}", goal.band + 1,
                     100.0 * *tuning.answer.wider_band_rate, goal.machines ? "machines" : "moves",
                     tuning.study.goals.size() > 1 ? fmt::format(" '{}'", goal.name) : std::string());
}

/// The condition under which a goal is lost first by more delay; 0 without conditions.
std::size_t delayed_condition(Of tuning) {
  return tuning::place_of_claim(tuning.study, tuning.answer.delay_lost->claim).condition;
}

std::string delay_sentence(Of tuning) {
  const TuneAnswer& answer = tuning.answer;
  if (!answer.delay_sought) return "";
  if (!answer.delay_lost)
    return tuning.study.conditions.empty()
               ? fmt::format("the goal seems met up to 5 samples more of controller.delay; it is {:g} here",
                             answer.delays.front())
               : std::string("the goals seem met up to 5 samples more of controller.delay");
  const std::string goal = several_goal_text(tuning.study, answer.delay_lost->claim);
  const double delay = answer.delays[delayed_condition(tuning)];
  if (tuning.study.conditions.empty())
    return fmt::format("the goal{} seems lost at controller.delay = {:.3g} samples; it is {:g} here", goal,
                       delay + answer.delay_lost->more, delay);
  return fmt::format(
      "with {:.3g} samples more of controller.delay the goal{} seems lost, first{}, where it is {:g}",
      answer.delay_lost->more, goal,
      study::condition_text(tuning.study, static_cast<std::int64_t>(delayed_condition(tuning))), delay);
}

/// What the rates of the tables are proportions of, where it is not the moves of all machines.
std::string rates_sentence(Of tuning) {
  const study::Study& study = tuning.study;
  const bool named = tuning::has_named_claims(study);
  const bool on_machines = study.goals.front().machines.has_value();
  if (tuning.answer.limits.empty() || !(named || on_machines || study.worlds > 0)) return "";
  if (study.goals.size() > 1)
    return fmt::format(
        "the rate of the goal, below, is of the worst goal{}{}: of machines where it is on machines, else of "
        "moves",
        study.conditions.empty() ? "" : fmt::format(" at its worst {}", study::turn_word(study)),
        study.worlds > 0 ? " in the worst world" : "");
  return fmt::format("the rate of the goal, below, is of {}{}{}", on_machines ? "machines" : "moves",
                     study.conditions.empty() ? "" : fmt::format(" at the worst {}", study::turn_word(study)),
                     study.worlds > 0 ? " in the worst world" : "");
}

struct RoomRow {
  const tuning::Room& room;
  const std::string& unit;
};

std::vector<RoomRow> room_rows(Of tuning) {
  std::vector<RoomRow> rows;
  for (std::size_t i = 0; i < tuning.answer.room.size(); ++i)
    rows.push_back({tuning.answer.room[i], tuning.answer.free[i].unit});
  return rows;
}

Description<RoomRow> room_columns() {
  using Row = const RoomRow&;
  return Description<RoomRow>()
      .value({.heading = "parameter"}, [](Row row) { return row.room.name; })
      .value({.heading = "goal seems met from"}, [](Row row) { return row.room.low; })
      .value({.heading = "to"}, [](Row row) { return row.room.high; })
      .value({.heading = "unit"}, [](Row row) { return row.unit; });
}

/// What several goals and conditions lose beyond the room: "controller.kp above its room: the goal 'small' is
/// lost under condition loaded".
std::string ends_of_room_sentence(Of tuning) {
  const study::Study& study = tuning.study;
  if (!tuning::has_named_claims(study)) return "";
  std::vector<std::string> ends;
  for (const tuning::Room& one : tuning.answer.room) {
    for (const auto& [lost, side] :
         {std::pair(one.lost_below, "below"), std::pair(one.lost_above, "above")}) {
      if (!lost) continue;
      const auto condition = static_cast<std::int64_t>(tuning::place_of_claim(study, *lost).condition);
      ends.push_back(fmt::format("{} {} its room: the goal{} is lost{}", one.name, side,
                                 several_goal_text(study, *lost), study::condition_text(study, condition)));
    }
  }
  return fmt::format("{}", fmt::join(ends, "\n"));
}

std::vector<std::pair<std::string, std::vector<double>>> ranges_of_room(Of tuning) {
  std::vector<std::pair<std::string, std::vector<double>>> ranges;
  for (const tuning::Room& one : tuning.answer.room)
    ranges.emplace_back(one.name, std::vector<double>{one.low, one.high});
  return ranges;
}

Description<Alternative> alternative_columns() {
  using Row = const Alternative&;
  return Description<Alternative>()
      .value({.heading = "control", .shown = Shown::to_people}, &Alternative::name)
      .value(in_data("fixed", "parameters that are not tuned, with their values"), &Alternative::fixed)
      .value(in_data("gains", "its best values by parameter; none if none keeps the margins"),
             &Alternative::gains)
      .value({.heading = "best values", .shown = Shown::to_people},
             [](Row row) { return row.verdict ? values_text(row.gains) : "none keeps the margins"; })
      .value({.key = "status",
              .heading = "goal",
              .meaning = "verdict on the goal",
              .words = goal::status_words()},
             [](Row row) {
               return row.verdict ? std::optional(goal::text_of(row.verdict->status)) : std::nullopt;
             })
      .value({.key = "rate",
              .heading = "moves that meet it",
              .meaning = "proportion of moves that meet the goal, with one-sided bounds",
              .unit = "1",
              .notation = Notation::percent},
             [](Row row) {
               return row.verdict ? std::optional(goal::bounded(row.verdict->moves)) : std::nullopt;
             })
      .value({.key = "goal_name",
              .heading = "worst goal",
              .meaning = "name of the worst goal, of several",
              .optional = true},
             &Alternative::worst_goal)
      .value({.key = "condition",
              .heading = "worst condition or age",
              .meaning = "name of the worst condition, with conditions",
              .optional = true},
             &Alternative::worst_condition)
      .value(criterion_item(),
             [](Row row) { return row.verdict ? std::optional(row.criterion) : std::nullopt; });
}

/// Whether the control does clearly better than the proven values, which could be the same: its other
/// parameters are 0 in their ranges.
bool is_better_within_ranges(const Alternative& one, const TuneAnswer& answer, bool on_machines) {
  constexpr double clearly = 0.95;
  if (one.fixed.empty() || !one.verdict || !answer.proof) return false;
  const goal::Verdict& proven = answer.proof->verdict;
  if (one.verdict->status == goal::Status::met && proven.status == goal::Status::met)
    return one.criterion < clearly * answer.criterion;
  if (one.verdict->status == goal::Status::met) return true;
  return on_machines ? one.verdict->machines.low > proven.machines.high
                     : one.verdict->moves.low > proven.moves.high;
}

std::string better_control_sentence(Of tuning) {
  std::string lines;
  const bool on_machines = worst_goal(tuning).machines.has_value();
  for (const Alternative& one : tuning.answer.alternatives) {
    if (!is_better_within_ranges(one, tuning.answer, on_machines)) continue;
    std::string settings;
    for (const auto& [name, value] : one.fixed) settings += fmt::format(" --set {}={}", name, value);
    for (const auto& [name, value] : one.gains) settings += fmt::format(" --set {}={}", name, value);
    lines += fmt::format("{}{} seems to do better, and lies in the ranges too; begin there:{}",
                         lines.empty() ? "" : "\n", one.name, settings);
  }
  return lines;
}

struct FrontierRow {
  const TriedPoint& point;
  const std::vector<study::FreeParameter>& free;
};

std::vector<FrontierRow> frontier_rows(Of tuning) {
  std::vector<FrontierRow> rows;
  for (const TriedPoint& one : tuning.answer.frontier) rows.push_back({one, tuning.answer.free});
  return rows;
}

/// A few points of the frontier, evenly spread over it.
std::vector<FrontierRow> some_frontier_rows(Of tuning) {
  constexpr std::int64_t most = 6;
  const std::vector<FrontierRow> all = frontier_rows(tuning);
  std::vector<FrontierRow> some;
  if (all.size() < 2) return some;
  for (const std::int64_t i : statistics::spread_over(std::ssize(all), most))
    some.push_back(all[static_cast<std::size_t>(i)]);
  return some;
}

Description<FrontierRow> frontier_columns() {
  using Row = const FrontierRow&;
  return Description<FrontierRow>()
      .value({.key = "gains", .heading = "values", .meaning = "values by parameter"},
             [](Row row) { return named(row.free, row.point.values); })
      .value({.key = "rate",
              .heading = "rate of the goal",
              .meaning = "rate of the goal by the search, which is a little too good",
              .unit = "1",
              .notation = Notation::percent},
             [](Row row) { return row.point.estimate.rate; })
      .value(criterion_item(), [](Row row) { return row.point.estimate.criterion; });
}

/// "holds with 10 other seeds (94.9 %) and half the delay (97 %); lost with twice the spread (80 %)".
std::string robustness_sentence(Of tuning) {
  std::string holds, lost, unknown;
  for (const tuning::Variation& one : tuning.answer.robustness) {
    std::string& list = !one.limit.rate ? unknown : one.holds ? holds : lost;
    list += (list.empty() ? "" : ", ") + one.limit.effect;
    if (one.limit.rate) list += fmt::format(" ({})", text::percent_near(*one.limit.rate));
  }
  std::string line;
  for (const auto& [words, list] : {std::pair("holds with ", &holds), std::pair("lost with ", &lost),
                                    std::pair("not simulated: ", &unknown)}) {
    if (!list->empty()) line += (line.empty() ? "" : "; ") + (words + *list);
  }
  return line.empty() ? line : line + '\n';
}

document::Description<tuning::Variation> variation_columns() {
  using tuning::Variation;
  return document::Description<Variation>()
      .value(in_data("premise", "what differs from the study"),
             [](const Variation& one) { return one.limit.effect; })
      .value(in_data("holds", "whether every goal is met under every condition"),
             [](const Variation& one) { return one.limit.rate ? std::optional(one.holds) : std::nullopt; })
      .value({.key = "rate",
              .meaning = "proportion of moves, or of machines, that meet the worst goal; of seeds the lowest",
              .unit = "1",
              .shown = Shown::in_json},
             [](const Variation& one) { return one.limit.rate; })
      .value({.key = "note",
              .meaning = "what stayed, or why there is no rate",
              .shown = Shown::in_json,
              .optional = true},
             [](const Variation& one) {
               return one.limit.note.empty() ? std::nullopt : std::optional(one.limit.note);
             });
}

}  // namespace

std::string several_goal_text(const study::Study& study, std::size_t claim) {
  if (study.goals.size() < 2) return "";
  return fmt::format(" '{}'", study.goals[tuning::place_of_claim(study, claim).goal].name);
}

document::Item criterion_item() {
  return {.key = "criterion",
          .heading = "criterion (–: never)",
          .meaning = "quantity that is minimised; unknown for never"};
}

void add_delay(Description<Tuning>& items) {
  items.sentence(wider_band_sentence)
      .value(in_data("wider_band_rate", "rate of the goal with a band one count wider, where it is not met",
                     "1"),
             [](Of t) { return t.answer.wider_band_rate; })
      .sentence(delay_sentence)
      .value(in_data("delay_lost",
                     "controller.delay from which on the goal seems lost; with conditions that of "
                     "the condition under which it is lost first",
                     "samples"),
             [](Of t) -> std::optional<double> {
               if (!t.answer.delay_lost) return {};
               return t.answer.delays[delayed_condition(t)] + t.answer.delay_lost->more;
             })
      .value({.key = "delay_lost_condition",
              .meaning = "that condition, with conditions",
              .shown = Shown::in_data,
              .optional = true},
             [](Of t) -> std::optional<std::string> {
               if (!t.answer.delay_lost) return {};
               return tuning::condition_name(t.study, {0, delayed_condition(t)});
             });
}

void add_room(Description<Tuning>& items) {
  items
      .value(in_data("room", "range of each parameter in which the goal seems met, the others as tuned"),
             ranges_of_room)
      .table({.heading = "room of each parameter, the others as tuned", .shown = Shown::to_people},
             room_columns(), room_rows)
      .sentence(ends_of_room_sentence)
      .figures(room_figures);
}

void add_robustness(Description<Tuning>& items) {
  items.sentence(robustness_sentence)
      .table({.key = "robustness",
              .meaning = "rates at the tuned values with other seeds, spreads and delays",
              .shown = Shown::in_json},
             variation_columns(),
             [](Of t) -> const std::vector<tuning::Variation>& { return t.answer.robustness; });
}

void add_controls(Description<Tuning>& items) {
  items
      .table({.key = "alternatives",
              .heading = "other controls, each at its own best values, on other machines than its search",
              .meaning = "simpler and other controls at their own best values"},
             alternative_columns(),
             [](Of t) -> const std::vector<Alternative>& { return t.answer.alternatives; })
      .sentence(better_control_sentence);
}

void add_limits(Description<Tuning>& items) {
  items.sentence(rates_sentence)
      .include(limits_description("what limits it, each by simulation on the machines of the search"),
               [](Of t) -> const std::vector<tuning::Limit>& { return t.answer.limits; });
}

void add_frontier(Description<Tuning>& items) {
  items
      .table(in_data("frontier", "points of the search that no other point beats in both rate and criterion"),
             frontier_columns(), frontier_rows)
      .table({.heading = "success and speed, by the search (its rates are a little too good)",
              .shown = Shown::to_people},
             frontier_columns(), some_frontier_rows);
}

}  // namespace zerocount::design_commands
