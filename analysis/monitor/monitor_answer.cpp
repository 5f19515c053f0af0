#include "analysis/monitor/monitor_answer.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/monitor/explanation_answer.hpp"
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

/// "0.04 s; baseline 0.05 s", or that of each like: "move 0: 0.04 s, baseline 0.05 s; …".
std::string medians_text(const MeasureState& state) {
  constexpr std::size_t max_shown = 3;
  if (state.by_like.empty())
    return fmt::format("{}; baseline {}", typical_text(state, state.median.value_or(*state.baseline_median)),
                       typical_text(state, *state.baseline_median));
  std::vector<std::string> texts;
  for (const LikeValue& like : state.by_like) {
    if (!like.median) continue;
    if (texts.size() == max_shown) {
      texts.push_back("…");
      break;
    }
    texts.push_back(fmt::format("{}: {}, baseline {}", like.like, typical_text(state, *like.median),
                                typical_text(state, like.baseline)));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

std::string changed_headline(const MonitorReading& r) {
  const MeasureState& alarm = *r.state.alarm;
  return fmt::format("changed: {} is {} since move {} ({}); alarm at move {} of {}", alarm.measure.name,
                     word_of(*alarm.direction), *alarm.since, medians_text(alarm), *alarm.alarm_at,
                     r.state.moves);
}

/// " in overshoot, creep": the measures that need more moves.
std::string unseen_text(const MonitorReading& r) {
  std::vector<std::string> names;
  for (const MeasureState& state : r.monitor.measures())
    if (!state.to_see.directions.empty() && !state.seen_after) names.push_back(state.measure.name);
  if (names.empty()) return ": no measure has a size of change to be seen";
  return fmt::format(" in {}", fmt::join(names, ", "));
}

/// The unit that is ranked, in the singular.
std::string_view unit_text(const MonitorReading& r) {
  return r.monitor.settings().group.empty() ? "block" : "group";
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
  if (r.monitor.values() == 0 && r.monitor.unlike() > 0)
    return fmt::format("undecided: none of {} is like one of the baseline; the first is {}",
                       moves_text(r.state.moves), text::printable(r.monitor.first_unlike()));
  if (r.monitor.values() == 0)
    return fmt::format("undecided: no {} of moves is complete after {}", unit_text(r),
                       moves_text(r.state.moves));
  return fmt::format("undecided: no alarm in {}, but a change of {} need not have been seen{}",
                     moves_text(r.state.moves), change_text(r), unseen_text(r));
}

/// The units that are ranked, in the plural: "moves", "blocks of 5 moves", "groups of day".
std::string values_text(const MonitorReading& r) {
  const MonitorSettings& settings = r.monitor.settings();
  if (!settings.group.empty()) return fmt::format("groups of {}", text::printable(settings.group));
  return settings.block == 1 ? "moves" : fmt::format("blocks of {} moves", settings.block);
}

std::string bound_sentence(const MonitorReading& r) {
  const bool is_plain = r.monitor.settings().group.empty();
  return fmt::format(
      "a false alarm within any number of moves has at most the probability {}, where the {} are "
      "exchangeable "
      "with those of the baseline ({}){}",
      text::percent(r.monitor.settings().alarm), values_text(r),
      is_plain ? moves_text(r.baseline.moves) : fmt::format("{}", r.monitor.baseline_values()),
      r.monitor.likes().count() > 1 ? " that are like them" : "");
}

std::string_view labels_text(const Likes& likes) {
  switch (likes.by()) {
    case LikeBy::number_and_target:
      return "move and target";
    case LikeBy::target:
      return "target and direction";
    case LikeBy::number:
      return "move";
    case LikeBy::direction:
      return "direction";
    case LikeBy::nothing:
      break;
  }
  return "";
}

std::string likes_sentence(const MonitorReading& r) {
  const Likes& likes = r.monitor.likes();
  if (likes.count() < 2) return "";
  std::vector<std::string> mirrored;
  for (const MeasureState& state : r.monitor.measures())
    if (state.measure.row->values.mirrored) mirrored.push_back(state.measure.name);
  return fmt::format("moves are compared with those of the same {} ({} in the baseline){}",
                     labels_text(likes), likes.count(),
                     mirrored.empty()
                         ? ""
                         : fmt::format("; {} by {}", fmt::join(mirrored, ", "),
                                       likes.takes_magnitudes() ? "magnitude" : "the direction of the move"));
}

std::string unlike_sentence(const MonitorReading& r) {
  if (r.monitor.unlike() == 0) return "";
  return fmt::format("{} without a like in the baseline {} not compared, the first of them {}",
                     moves_text(r.monitor.unlike()), r.monitor.unlike() == 1 ? "is" : "are",
                     text::printable(r.monitor.first_unlike()));
}

std::string continued_sentence(const MonitorReading& r) {
  if (r.monitor.continued() == 0) return "";
  return fmt::format("{} of the last group of the baseline {} not compared",
                     moves_text(r.monitor.continued()), r.monitor.continued() == 1 ? "is" : "are");
}

/// Measures whose baseline alternates, or not.
std::vector<std::string> dependent_names(const MonitorReading& r, bool alternates) {
  std::vector<std::string> names;
  for (const MeasureState* const state : r.monitor.dependent())
    if (state->dependence.alternates == alternates) names.push_back(state->measure.name);
  return names;
}

std::string dependent_sentence(const MonitorReading& r) {
  std::int64_t over = 0;
  for (const MeasureState* const state : r.monitor.dependent())
    if (!state->dependence.alternates) over = std::max(over, state->dependence.over);
  const std::vector<std::string> names = dependent_names(r, false);
  if (names.empty()) return "";
  const std::string remedy =
      r.baseline.groups.empty()
          ? fmt::format(
                "a column of what neighbours have in common, such as the day (--group), or longer "
                "blocks (--block, now {}) make them rarer",
                r.monitor.settings().block)
          : "a column of larger groups makes them rarer";
  return fmt::format(
      "in the baseline neighbours resemble each other in {}, over some {} {}, so that they are not "
      "exchangeable: false alarms are more frequent; {}",
      fmt::join(names, ", "), over, values_text(r), remedy);
}

std::string alternating_sentence(const MonitorReading& r) {
  const std::vector<std::string> names = dependent_names(r, true);
  if (names.empty()) return "";
  return fmt::format(
      "in the baseline neighbours differ more than others in {}, as if moves of several kinds took turns: a "
      "column 'move' or 'target' in both files compares moves with their like",
      fmt::join(names, ", "));
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

std::string explanation_sentence(const MonitorReading& r) {
  return r.explanation == nullptr ? "" : explanation_text(*r.explanation);
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
      .value(
          in_data("baseline",
                  "median of the baseline, of a quality its proportion; null: never, or one for each like: "
                  "see `likes`"),
          &MeasureState::baseline_median)
      .value(
          in_data("moves", "likewise of the moves, since the change if there is one; null: none, or never"),
          &MeasureState::median)
      .value({.heading = "baseline", .shown = document::Shown::to_people, .numeric = true},
             [](Of s) -> std::optional<std::string> {
               if (!s.baseline_median) return std::nullopt;
               return s.measure.quality ? text::percent_near(*s.baseline_median)
                                        : text::short_number(*s.baseline_median);
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
      .value(in_data("dependence",
                     "p-value of the order of the baseline's values, if they are exchangeable; null: of a "
                     "simulated one",
                     "1"),
             [](Of s) { return s.correlation ? std::optional(s.dependence.p) : std::nullopt; })
      .value({"seen_after", "seen after",
              "moves after which a change of the asked size would have been seen with 90 %, where there are "
              "as many; "
              "null: later, or not asked"},
             &MeasureState::seen_after);
}

document::Description<LikeValue> like_description() {
  using document::Notation;
  return document::Description<LikeValue>()
      .value({"measure", "measure", "name of the measure"}, &LikeValue::measure)
      .value({"like", "moves like", "what these moves have in common"}, &LikeValue::like)
      .value({.key = "baseline",
              .heading = "baseline",
              .meaning = "their median in the baseline; null: never",
              .notation = Notation::four_digits},
             &LikeValue::baseline)
      .value({"baseline_moves", "of", "of so many moves"}, &LikeValue::baseline_moves)
      .value({.key = "median",
              .heading = "moves",
              .meaning = "their median in the log, since the change if there is one; null: none, or never",
              .notation = Notation::four_digits},
             &LikeValue::median)
      .value({"moves", "of", "of so many moves"}, &LikeValue::moves);
}

std::vector<LikeValue> like_values(const MonitorReading& r) {
  std::vector<LikeValue> all;
  for (const MeasureState& state : r.monitor.measures())
    all.insert(all.end(), state.by_like.begin(), state.by_like.end());
  return all;
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
      .value(in_data("group", "column of the groups that are one value each; null: none"),
             [](Of r) {
               const std::string& group = r.monitor.settings().group;
               return group.empty() ? std::nullopt : std::optional(group);
             })
      .value(in_data("values", "values that were compared: moves, blocks or groups"),
             [](Of r) { return r.monitor.values(); })
      .value(in_data("baseline", "file of the baseline"), [](Of r) { return r.baseline.name; })
      .value(in_data("log", "file of the moves"), [](Of r) { return r.log; })
      .value(in_data("baseline_moves", "moves of the baseline"), [](Of r) { return r.baseline.moves; })
      .value(in_data("baseline_machines", "simulated machines of the baseline; null: it was measured"),
             [](Of r) { return r.baseline.is_model ? std::optional(r.baseline.machines) : std::nullopt; })
      .value(in_data("unused", "columns of the moves that nothing is compared with"),
             [](Of r) { return r.monitor.unused(); })
      .value(in_data("alike", "what moves are compared by; empty: all with all"),
             [](Of r) { return std::string(labels_text(r.monitor.likes())); })
      .value(in_data("unlike", "moves that the baseline has none like, which are not compared"),
             [](Of r) { return r.monitor.unlike(); })
      .table({.key = "measures", .meaning = "each measure"}, measure_description(),
             [](Of r) { return r.monitor.measures(); })
      .table(
          {.key = "likes",
           .meaning = "medians of measures that differ from one kind of moves to another more than within"},
          like_description(), like_values)
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
      .sentence(likes_sentence)
      .sentence(unlike_sentence)
      .sentence(continued_sentence)
      .sentence(bound_sentence)
      .sentence(dependent_sentence)
      .sentence(alternating_sentence)
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
