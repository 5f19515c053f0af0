#include "analysis/monitor/monitor_answer.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::monitor {
namespace {

std::string_view word_of(MachineStatus status) {
  switch (status) {
    case MachineStatus::changed:
      return "changed";
    case MachineStatus::unchanged:
      return "unchanged";
    case MachineStatus::undecided:
      break;
  }
  return "undecided";
}

std::string_view word_of(Direction direction) {
  return direction == Direction::higher ? "higher" : "lower";
}

std::string typical_text(const MeasureState& state, double value) {
  if (state.measure.quality) return text::percent_near(value);
  if (std::isinf(value)) return "never";
  const std::string number = text::short_number(value);
  return state.unit.empty() || state.unit == "1" ? number : fmt::format("{} {}", number, state.unit);
}

std::string moves_text(std::int64_t moves) {
  return fmt::format("{} move{}", moves, moves == 1 ? "" : "s");
}

std::string change_text(const MonitorReading& r) {
  const std::optional<double>& change = r.monitor.settings().change;
  return change ? fmt::format("{} of the baseline's median, or {:g} of a proportion,", text::percent(*change),
                              *change)
                : std::string("20 % of the baseline's median, or 0.1 of a proportion,");
}

std::string changed_headline(const MonitorReading& r) {
  const MeasureState& alarm = *r.state.alarm;
  return fmt::format("changed: {} is {} since move {} ({}; baseline {}); alarm at move {} of {}",
                     alarm.measure.name, word_of(*alarm.direction), *alarm.since,
                     typical_text(alarm, alarm.median.value_or(alarm.baseline_median)),
                     typical_text(alarm, alarm.baseline_median), *alarm.alarm_at, r.state.moves);
}

/// " in overshoot, creep": the measures that need more moves.
std::string unseen_text(const MonitorReading& r) {
  std::vector<std::string> names;
  for (const MeasureState& state : r.monitor.measures())
    if (!state.to_see.directions.empty() && !state.seen_after) names.push_back(state.measure.name);
  if (names.empty()) return ": no measure has a size of change to be seen";
  return fmt::format(" in {}", fmt::join(names, ", "));
}

std::string headline_of(const MonitorReading& r) {
  switch (r.state.status) {
    case MachineStatus::changed:
      return changed_headline(r);
    case MachineStatus::unchanged:
      return fmt::format("unchanged: no alarm in {}, where a change of {} would have been seen with 90 %",
                         moves_text(r.state.moves), change_text(r));
    case MachineStatus::undecided:
      break;
  }
  if (r.state.moves == 0) return "undecided: there are no moves yet";
  return fmt::format("undecided: no alarm in {}, but a change of {} need not have been seen{}",
                     moves_text(r.state.moves), change_text(r), unseen_text(r));
}

std::string bound_sentence(const MonitorReading& r) {
  return fmt::format(
      "a false alarm within any number of moves has at most the probability {}, where {} are exchangeable "
      "with those of the baseline ({})",
      text::percent(r.monitor.settings().alarm),
      r.monitor.settings().block == 1 ? std::string("the moves")
                                      : fmt::format("blocks of {} moves", r.monitor.settings().block),
      moves_text(r.baseline.moves));
}

std::string dependent_sentence(const MonitorReading& r) {
  const std::vector<std::string> names = r.monitor.dependent();
  if (names.empty()) return "";
  return fmt::format(
      "they are not in the baseline, where successive values correlate in {}: false alarms are more "
      "frequent, and longer blocks (--block, now {}) make them rarer",
      fmt::join(names, ", "), r.monitor.settings().block);
}

std::string model_sentence(const MonitorReading& r) {
  if (!r.baseline.is_model) return "";
  if (r.baseline.machines == 1)
    return "the baseline is a simulated machine: an alarm can mean that the model is wrong, not that the "
           "machine "
           "changed";
  return fmt::format(
      "the baseline is a model of {} machines: an alarm can mean that the model is wrong, or that this "
      "machine is "
      "not an average one, not that it changed; whether it changed is told by its own first moves as the "
      "baseline",
      r.baseline.machines);
}

std::string_view word_of(ChangeTold told) {
  switch (told) {
    case ChangeTold::one:
      return "one";
    case ChangeTold::several:
      return "several";
    case ChangeTold::none:
      return "none";
    case ChangeTold::unknown:
      break;
  }
  return "unknown";
}

/// "12 to 20 %", "0.08 to 0.12 counts"; an end that is nothing is left out.
std::string interval_text(const ParameterChange& change, double least, double most, bool beyond) {
  const std::string unit = change.kind == ChangeKind::factor ? " %"
                           : change.unit.empty()             ? ""
                                                             : " " + change.unit;
  if (beyond) return fmt::format("at least {:.2g}{}", least, unit);
  return fmt::format("{:.2g} to {:.2g}{}", least, most, unit);
}

/// "friction.k1 lower by 12 to 20 %", "encoder.fine_errors.noise higher by 0.08 to 0.12 count".
std::string change_text(const ParameterChange& change) {
  const bool is_factor = change.kind == ChangeKind::factor;
  const auto off = [&](double end) { return is_factor ? 100.0 * std::abs(end - 1.0) : std::abs(end); };
  const double unchanged = unchanged_by(change.kind);
  const bool lower = change.high <= unchanged;
  if (!lower && change.low < unchanged) {
    const std::string unit = is_factor ? " %" : change.unit.empty() ? "" : " " + change.unit;
    return fmt::format("{} between {:.2g}{} lower and {:.2g}{} higher", change.parameter, off(change.low),
                       unit, off(change.high), unit);
  }
  return fmt::format(
      "{} {} by {}", change.parameter, lower ? "lower" : "higher",
      interval_text(change, off(lower ? change.high : change.low), off(lower ? change.low : change.high),
                    lower ? change.beyond_low : change.beyond_high));
}

std::string explanation_sentence(const MonitorReading& r) {
  if (r.explanation == nullptr) return "";
  const ChangeExplanation& explanation = *r.explanation;
  std::vector<std::string> texts;
  for (const ParameterChange& change : explanation.parameters)
    texts.push_back(fmt::format("{} ({})", change_text(change), text::percent_near(change.probability)));
  const std::string compared =
      explanation.since > 1
          ? fmt::format("since move {}, compared with the machine's own moves before", explanation.since)
          : std::string("compared with the simulated machines, from the first move on");
  switch (explanation.told) {
    case ChangeTold::one:
      return fmt::format("if one parameter of the model differs, it is {}, {}",
                         change_text(explanation.parameters[0]), compared);
    case ChangeTold::several:
      return fmt::format("which parameter differs cannot be told from these measures: {}; {}",
                         fmt::join(texts, ", or "), compared);
    case ChangeTold::none:
      return fmt::format("no single parameter of those tried explains these moves; nearest: {}; {}",
                         fmt::join(texts, ", or "), compared);
    case ChangeTold::unknown:
      break;
  }
  return fmt::format("which parameter changed is not told: {}", explanation.reason);
}

/// Reads a member of a change of this kind; nothing for a change of another kind.
template <ChangeKind kind>
auto of_kind(double ParameterChange::*member) {
  return [member](const ParameterChange& change) {
    return change.kind == kind ? std::optional(change.*member) : std::nullopt;
  };
}

document::Description<ParameterChange> parameter_description() {
  using document::Notation;
  const auto factor = of_kind<ChangeKind::factor>;
  const auto amount = of_kind<ChangeKind::amount>;
  const auto item = [](const char* key, const char* heading, const char* meaning) {
    return document::Item{
        .key = key, .heading = heading, .meaning = meaning, .notation = Notation::three_digits};
  };
  return document::Description<ParameterChange>()
      .value({"parameter", "parameter", "dotted path"}, &ParameterChange::parameter)
      .value(item("factor", "times", "most likely factor by which it changed; null: something was added"),
             factor(&ParameterChange::change))
      .value(item("low", "from", "low end of the 95 % interval of the factor"), factor(&ParameterChange::low))
      .value(item("high", "to", "high end of it"), factor(&ParameterChange::high))
      .value(
          item("amount", "plus", "most likely amount that was added, in its unit; null: it was multiplied"),
          amount(&ParameterChange::change))
      .value(item("amount_low", "from", "low end of the 95 % interval of the amount"),
             amount(&ParameterChange::low))
      .value(item("amount_high", "to", "high end of it"), amount(&ParameterChange::high))
      .value({.key = "probability",
              .heading = "probability",
              .meaning = "that it is this parameter, if it is one of those tried",
              .unit = "1",
              .notation = Notation::percent},
             &ParameterChange::probability);
}

std::vector<std::string> not_judged(const MonitorReading& r) {
  std::vector<std::string> names;
  for (const MeasureState& state : r.monitor.measures())
    if (state.to_see.directions.empty()) names.push_back(state.measure.name);
  return names;
}

std::string not_judged_sentence(const MonitorReading& r) {
  const std::vector<std::string> names = not_judged(r);
  if (names.empty() || r.state.alarm != nullptr) return "";
  return fmt::format(
      "without a size of change to be seen, because the median is 0 or infinite, values have both signs, or "
      "a proportion cannot change so much: {}",
      fmt::join(names, ", "));
}

std::string unused_sentence(const MonitorReading& r) {
  if (r.monitor.unused().empty()) return "";
  return fmt::format("columns that are not compared: {}",
                     text::printable(fmt::format("{}", fmt::join(r.monitor.unused(), ", "))));
}

template <class Value, class Get>
std::optional<Value> of_alarm(const MonitorReading& r, Get get) {
  return r.state.alarm == nullptr ? std::nullopt : std::optional<Value>(get(*r.state.alarm));
}

document::Description<MeasureState> measure_description() {
  using document::in_data;
  using document::with_words;
  using Of = const MeasureState&;
  const std::vector<std::string> directions{"higher", "lower"};
  return document::Description<MeasureState>()
      .value({"measure", "measure", "name of the measure"}, [](Of s) { return s.measure.name; })
      .value({"unit", "unit", "its unit"}, [](Of s) { return s.unit; })
      .value(in_data("baseline", "median of the baseline, of a quality its proportion; null: never"),
             &MeasureState::baseline_median)
      .value(
          in_data("moves", "likewise of the moves, since the change if there is one; null: none, or never"),
          &MeasureState::median)
      .value({.heading = "baseline", .shown = document::Shown::to_people, .numeric = true},
             [](Of s) {
               return s.measure.quality ? text::percent_near(s.baseline_median)
                                        : text::short_number(s.baseline_median);
             })
      .value({.heading = "moves", .shown = document::Shown::to_people, .numeric = true},
             [](Of s) -> std::optional<std::string> {
               if (!s.median) return std::nullopt;
               return s.measure.quality ? text::percent_near(*s.median) : text::short_number(*s.median);
             })
      .value({.key = "evidence",
              .heading = "evidence",
              .meaning =
                  "largest capital of the bets on a change of the measure, as a part of the alarm's scale",
              .unit = "1",
              .notation = document::Notation::three_digits},
             &MeasureState::evidence)
      .value(with_words({"direction", "direction", "of the change; null: no alarm"}, directions),
             [](Of s) { return s.direction ? std::optional(word_of(*s.direction)) : std::nullopt; })
      .value({"since", "since", "first move of the change, from 1; null: no alarm"}, &MeasureState::since)
      .value({"alarm_at", "alarm at", "move of the alarm, from 1; null: none"}, &MeasureState::alarm_at)
      .value(in_data("correlation",
                     "rank correlation of successive values of the baseline; null: of a simulated one", "1"),
             &MeasureState::correlation)
      .value({"seen_after", "seen after",
              "moves after which a change of the asked size would have been seen with 90 %, where there are "
              "as many; "
              "null: later, or not asked"},
             &MeasureState::seen_after);
}

}  // namespace

document::AnswerDescription<MonitorReading> monitor_answer() {
  using document::in_data;
  using document::with_words;
  using Of = const MonitorReading&;
  document::AnswerDescription<MonitorReading> answer{
      {.name = "monitor", .meaning = "whether a machine has changed", .csv_table = "measures"}, {}};
  answer.items.headline(headline_of)
      .value(
          with_words(in_data("status", "whether the machine changed"), {"changed", "unchanged", "undecided"}),
          [](Of r) { return word_of(r.state.status); })
      .value(
          in_data("measure", "measure of the first alarm; null: none"),
          [](Of r) { return of_alarm<std::string>(r, [](const MeasureState& s) { return s.measure.name; }); })
      .value(with_words(in_data("direction", "direction of its change; null: no alarm"), {"higher", "lower"}),
             [](Of r) {
               return of_alarm<std::string>(r, [](const MeasureState& s) { return word_of(*s.direction); });
             })
      .value(in_data("since", "estimated first move of the change, from 1; null: no alarm"),
             [](Of r) { return of_alarm<std::int64_t>(r, [](const MeasureState& s) { return *s.since; }); })
      .value(
          in_data("alarm_at", "move of the alarm, from 1; null: none"),
          [](Of r) { return of_alarm<std::int64_t>(r, [](const MeasureState& s) { return *s.alarm_at; }); })
      .value(in_data("moves", "moves seen"), [](Of r) { return r.state.moves; })
      .value(in_data("evidence", "e-value against no change, the largest until now; the alarm is at 1/alarm",
                     "1"),
             [](Of r) { return r.state.evidence; })
      .value(in_data("alarm", "largest probability of a false alarm within any number of moves", "1"),
             [](Of r) { return r.monitor.settings().alarm; })
      .value(in_data("block", "consecutive moves that are one value"),
             [](Of r) { return r.monitor.settings().block; })
      .value(in_data("baseline", "file of the baseline"), [](Of r) { return r.baseline.name; })
      .value(in_data("log", "file of the moves"), [](Of r) { return r.log; })
      .value(in_data("baseline_moves", "moves of the baseline"), [](Of r) { return r.baseline.moves; })
      .value(in_data("baseline_machines", "simulated machines of the baseline; null: it was measured"),
             [](Of r) { return r.baseline.is_model ? std::optional(r.baseline.machines) : std::nullopt; })
      .value(in_data("unused", "columns of the moves that nothing is compared with"),
             [](Of r) { return r.monitor.unused(); })
      .table({.key = "measures", .meaning = "each measure"}, measure_description(),
             [](Of r) { return r.monitor.measures(); })
      .value(
          with_words(
              in_data("told", "what is told of the parameters of the model after an alarm; null: not asked"),
              {"one", "several", "none", "unknown"}),
          [](Of r) { return r.explanation ? std::optional(word_of(r.explanation->told)) : std::nullopt; })
      .value(in_data("parameters_since", "first move that the parameters are of, from 1; null: not asked"),
             [](Of r) { return r.explanation ? std::optional(r.explanation->since) : std::nullopt; })
      .value(in_data("tried", "parameters of the model that may have changed"),
             [](Of r) { return r.explanation ? r.explanation->tried : std::vector<std::string>{}; })
      .sentence(explanation_sentence)
      .table({.key = "parameters", .meaning = "parameters of the model that explain the change"},
             parameter_description(),
             [](Of r) { return r.explanation ? r.explanation->parameters : std::vector<ParameterChange>{}; })
      .sentence(not_judged_sentence)
      .sentence(unused_sentence)
      .sentence(bound_sentence)
      .sentence(dependent_sentence)
      .sentence(model_sentence);
  return answer;
}

ExitCode exit_code_of(MachineStatus status) {
  switch (status) {
    case MachineStatus::changed:
      return ExitCode::regression;
    case MachineStatus::unchanged:
      return ExitCode::success;
    case MachineStatus::undecided:
      break;
  }
  return ExitCode::inconclusive;
}

}  // namespace zerocount::monitor
