#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/text/text.hpp"
#include "runners/design_commands/tune_parts.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::in_data;
using document::Notation;
using document::Shown;
using summary::MoveBehaviour;
using summary::UpperValues;
using text::short_number;
using tuning::Refusal;

using Moves = const MoveBehaviour&;

/// "<key>_p95" and "<key>_max" of upper values, for data only.
void add_upper(Description<MoveBehaviour>& columns, const std::string& key, const std::string& meaning,
               const std::string& unit, UpperValues MoveBehaviour::*values) {
  columns
      .value(in_data(key + "_p95", meaning + ", which 95 % of the moves do not exceed", unit),
             [values](Moves row) { return (row.*values).p95; })
      .value(in_data(key + "_max", "largest " + meaning, unit),
             [values](Moves row) { return (row.*values).max; });
}

std::optional<double> of_rest(Moves row, double summary::RestTorque::*value) {
  return row.rest ? std::optional((*row.rest).*value) : std::nullopt;
}

/// A row, and the axis that it is of, whose units people are shown.
struct RowOnAxis {
  const MoveBehaviour& moves;
  parameters::AxisKind axis;

  /// The value on such an axis; nothing, so that the column is left out, on another.
  std::optional<double> on(parameters::AxisKind kind, double value) const {
    return kind == axis ? std::optional(value) : std::nullopt;
  }
};
using OnAxis = const RowOnAxis&;

/// What people are shown of a row.
void add_shown_columns(Description<RowOnAxis>& columns) {
  using parameters::AxisKind;
  const auto to_people = [](const std::string& heading, Notation notation = Notation::four_digits) {
    return document::Item{.heading = heading, .notation = notation, .shown = Shown::to_people};
  };
  columns.value(to_people("overshoot p95 (counts)"), [](OnAxis row) { return row.moves.overshoot.p95; })
      .value(to_people("(rad)"),
             [](OnAxis row) { return row.on(AxisKind::rotary, row.moves.overshoot_length.p95); })
      .value(to_people("(m)"),
             [](OnAxis row) { return row.on(AxisKind::linear, row.moves.overshoot_length.p95); })
      .value(to_people("(of the step)", Notation::percent),
             [](OnAxis row) { return row.moves.overshoot_of_step.p95; })
      .value(to_people("peak torque (N m)"),
             [](OnAxis row) { return row.on(AxisKind::rotary, row.moves.peak_torque.max); })
      .value(to_people("peak force (N)"),
             [](OnAxis row) { return row.on(AxisKind::linear, row.moves.peak_torque.max); })
      .value(to_people("of the range", Notation::percent),
             [](OnAxis row) { return row.moves.peak_of_range.max; })
      .value(to_people("moves that saturate", Notation::percent),
             [](OnAxis row) { return row.moves.saturated; })
      .value(to_people("rms torque at rest"),
             [](OnAxis row) { return of_rest(row.moves, &summary::RestTorque::rms); })
      .value(to_people("of it changes"),
             [](OnAxis row) { return of_rest(row.moves, &summary::RestTorque::changes); });
}

Description<MoveBehaviour> behaviour_columns() {
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
      .value({.key = "moves", .heading = "moves", .meaning = "moves of these trials"}, &MoveBehaviour::moves);
  add_upper(columns, "overshoot", "excursion beyond the target", "count", &MoveBehaviour::overshoot);
  add_upper(columns, "overshoot_length", "excursion beyond the target, rad (m on a linear axis)", "",
            &MoveBehaviour::overshoot_length);
  add_upper(columns, "overshoot_of_step", "excursion beyond the target as a proportion of the move's step",
            "1", &MoveBehaviour::overshoot_of_step);
  add_upper(columns, "peak_torque", "absolute torque decided, N m (N on a linear axis)", "",
            &MoveBehaviour::peak_torque);
  add_upper(columns, "peak_of_range", "absolute torque as a proportion of the converter's largest", "1",
            &MoveBehaviour::peak_of_range);
  columns
      .value(in_data("saturated", "moves in which the converter clipped, as a proportion", "1"),
             &MoveBehaviour::saturated)
      .value(in_data("rest_torque_rms", "rms of the torque at rest, N m (N on a linear axis)"),
             [](Moves row) { return of_rest(row, &summary::RestTorque::rms); })
      .value(in_data("rest_torque_changes",
                     "rms of its changes from sample to sample, N m (N on a linear axis)"),
             [](Moves row) { return of_rest(row, &summary::RestTorque::changes); })
      .value(in_data("rest_torque_changes_of_range",
                     "the same as a proportion of the converter's largest torque", "1"),
             [](Moves row) { return of_rest(row, &summary::RestTorque::of_range); });
  return columns;
}

Description<RowOnAxis> shown_columns() {
  Description<RowOnAxis> columns;
  columns.include(behaviour_columns(), [](OnAxis row) -> const MoveBehaviour& { return row.moves; });
  add_shown_columns(columns);
  return columns;
}

/// "an engineer would refuse this: …; add limits: {overshoot: 50}".
std::string refusal_text(const Refusal& refusal) {
  return fmt::format("{}; to exclude it add {}", refusal.text, refusal.remedy);
}

std::string refusals_sentence(Of tuning) {
  std::string lines;
  for (const Refusal& one : tuning.answer.refusals)
    lines += fmt::format("a drive engineer would refuse this: {}\n", refusal_text(one));
  return lines;
}

Description<Refusal> refusal_columns() {
  return Description<Refusal>()
      .value({.key = "finding",
              .meaning = "what an engineer would refuse",
              .words = {"overshoot", "saturation", "torque noise", "phase margin"}},
             &Refusal::finding)
      .value(in_data("text", "the finding in a sentence"), &Refusal::text)
      .value(in_data("value",
                     "proportion of the step, of the moves, of the converter's largest torque; degrees"),
             &Refusal::value)
      .value(in_data("passes", "the value that passes"), &Refusal::largest)
      .value(in_data("remedy", "what excludes it, as it stands in a manifest"), &Refusal::remedy);
}

/// The largest finite value of the rows.
double largest_of(const std::vector<MoveBehaviour>& rows, double (*value)(Moves)) {
  double largest = 0.0;
  for (Moves row : rows) {
    if (value(row) > largest) largest = value(row);
  }
  return largest;
}

}  // namespace

std::string sanity_line(Of tuning) {
  const tuning::TuneAnswer& answer = tuning.answer;
  if (!answer.refusals.empty()) {
    std::vector<std::string> texts;
    for (const Refusal& one : answer.refusals) texts.push_back(refusal_text(one));
    return fmt::format("before the proof: a drive engineer would refuse {}: {}",
                       values_text(named(answer.free, answer.gains)), fmt::join(texts, "; "));
  }
  if (answer.behaviour.empty()) return "";
  const auto percent = [&](double (*value)(Moves)) { return 100.0 * largest_of(answer.behaviour, value); };
  return fmt::format(
      "before the proof: overshoot {:.3g} % of the step (95 % of the moves), peak torque {:.3g} % of the "
      "converter's range, {:.3g} % of the moves saturate{}: nothing that a drive engineer would refuse",
      percent([](Moves row) { return row.overshoot_of_step.p95; }),
      percent([](Moves row) { return row.peak_of_range.max; }),
      percent([](Moves row) { return row.saturated; }),
      answer.margins && std::isfinite(answer.margins->phase)
          ? fmt::format(", phase margin {}°", short_number(answer.margins->phase))
          : std::string());
}

void add_refusals(Description<Tuning>& items) {
  items.sentence(refusals_sentence)
      .table(in_data("refusals",
                     "what a drive engineer would refuse of the tuned values, although they may meet "
                     "the goal"),
             refusal_columns(), [](Of t) -> const std::vector<Refusal>& { return t.answer.refusals; });
}

void add_behaviour(Description<Tuning>& items) {
  items.table(
      {.key = "behaviour",
       .heading = "what the moves of the proof do",
       .meaning = "what the moves of the proof do, by goal and condition; the torque at rest is of machines "
                  "of the search where the study does not measure it"},
      shown_columns(), [](Of t) {
        std::vector<RowOnAxis> rows;
        for (const MoveBehaviour& one : t.answer.behaviour) rows.push_back({one, t.study.units.axis});
        return rows;
      });
}

}  // namespace zerocount::design_commands
