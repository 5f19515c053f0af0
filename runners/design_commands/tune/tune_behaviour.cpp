#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runners/design_commands/tune/tune_parts.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::in_data;
using document::Notation;
using summary::MoveBehaviour;
using summary::UpperValues;
using tuning::Refusal;

using Moves = const MoveBehaviour&;

/// "<key>_p95" and "<key>_max" of upper values. People are shown what has a heading.
void add_upper(Description<MoveBehaviour>& columns, const document::Item& of,
               UpperValues MoveBehaviour::*values, const std::string& p95_heading,
               const std::string& max_heading) {
  const auto item = [&of](const std::string& key, const std::string& heading, const std::string& meaning) {
    document::Item one = of;
    one.key = of.key + key;
    one.heading = heading;
    one.meaning = meaning;
    return one;
  };
  columns
      .value(item("_p95", p95_heading, of.meaning + ", which 95 % of the moves do not exceed"),
             [values](Moves row) { return (row.*values).p95; })
      .value(item("_max", max_heading, "largest " + of.meaning),
             [values](Moves row) { return (row.*values).max; });
}

std::optional<double> of_rest(Moves row, double summary::RestTorque::*value) {
  return row.rest ? std::optional((*row.rest).*value) : std::nullopt;
}

Description<MoveBehaviour> behaviour_columns() {
  using document::everywhere;
  Description<MoveBehaviour> columns;
  columns
      .value({.key = "goal",
              .heading = "goal",
              .meaning = "name of the goal that asks the moves",
              .optional = true},
             &MoveBehaviour::goal)
      .value({.key = "condition",
              .heading = "condition",
              .meaning = "the condition that the machines bear",
              .optional = true},
             &MoveBehaviour::condition)
      .value(everywhere("moves", "moves", "moves of these trials"), &MoveBehaviour::moves);
  add_upper(columns, {.key = "overshoot", .meaning = "excursion beyond the target", .unit = "count"},
            &MoveBehaviour::overshoot, "overshoot p95 (counts)", "");
  add_upper(columns,
            {.key = "overshoot_length", .meaning = "excursion beyond the target, rad (m on a linear axis)"},
            &MoveBehaviour::overshoot_length, "(rad, m)", "");
  add_upper(columns,
            {.key = "overshoot_of_step",
             .meaning = "excursion beyond the target as a proportion of the move's step",
             .unit = "1",
             .notation = Notation::percent},
            &MoveBehaviour::overshoot_of_step, "(of the step)", "");
  add_upper(columns, {.key = "peak_torque", .meaning = "absolute torque decided, N m (N on a linear axis)"},
            &MoveBehaviour::peak_torque, "", "peak torque (N m, N)");
  add_upper(columns,
            {.key = "peak_of_range",
             .meaning = "absolute torque as a proportion of the converter's largest",
             .unit = "1",
             .notation = Notation::percent},
            &MoveBehaviour::peak_of_range, "", "of the range");
  columns
      .value({.key = "saturated",
              .heading = "moves that saturate",
              .meaning = "moves in which the converter clipped, as a proportion",
              .unit = "1",
              .notation = Notation::percent},
             &MoveBehaviour::saturated)
      .value(everywhere("rest_torque_rms", "rms torque at rest",
                        "rms of the torque at rest, N m (N on a linear axis)"),
             [](Moves row) { return of_rest(row, &summary::RestTorque::rms); })
      .value(everywhere("rest_torque_changes", "of its changes",
                        "rms of its changes from sample to sample, N m (N on a linear axis)"),
             [](Moves row) { return of_rest(row, &summary::RestTorque::changes); })
      .value(in_data("rest_torque_changes_of_range",
                     "the same as a proportion of the converter's largest torque", "1"),
             [](Moves row) { return of_rest(row, &summary::RestTorque::of_range); });
  return columns;
}

}  // namespace

std::string sanity_line(Of tuning) {
  const tuning::TuneAnswer& answer = tuning.answer;
  if (answer.behaviour.empty() && answer.refusals.empty()) return "";
  std::vector<std::string> texts;
  for (const Refusal& one : answer.refusals)
    texts.push_back(fmt::format("{}; to exclude it add {}", one.text, one.remedy));
  return fmt::format("before the proof: a drive engineer would refuse {} of {}{}{}",
                     texts.empty() ? "nothing" : "this", values_text(named(answer.free, answer.gains)),
                     texts.empty() ? "" : ": ", fmt::join(texts, "; "));
}

void add_refusals(Items& items) {
  items.table({.key = "refusals",
               .heading = "a drive engineer would refuse this",
               .meaning = "what a drive engineer would refuse of the tuned values, although they may meet "
                          "the goal"},
              Description<Refusal>()
                  .value({.key = "finding",
                          .meaning = "what an engineer would refuse",
                          .words = {"overshoot", "saturation", "torque noise", "phase margin"}},
                         &Refusal::finding)
                  .value(document::everywhere("text", "finding", "the finding in a sentence"), &Refusal::text)
                  .value(in_data("value",
                                 "proportion of the step, of the moves, of the converter's largest "
                                 "torque; degrees"),
                         &Refusal::value)
                  .value(in_data("passes", "the value that passes"), &Refusal::largest)
                  .value(document::everywhere("remedy", "to exclude it add",
                                              "what excludes it, as it stands in a manifest"),
                         &Refusal::remedy),
              [](Of t) -> const std::vector<Refusal>& { return t.answer.refusals; });
}

void add_behaviour(Description<Tuning>& items) {
  items.table(
      {.key = "behaviour",
       .heading = "what the moves of the proof do",
       .meaning = "what the moves of the proof do, by goal and condition; the torque at rest is of machines "
                  "of the search where the study does not measure it"},
      behaviour_columns(), [](Of t) -> const std::vector<MoveBehaviour>& { return t.answer.behaviour; });
}

}  // namespace zerocount::design_commands
