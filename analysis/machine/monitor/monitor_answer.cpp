#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/machine/monitor/machine_monitor.hpp"

namespace zerocount::monitor {
namespace {

using document::Description;
using document::everywhere;
using document::in_data;
using document::Notation;
using document::with_words;

// Words in the order of the enumerations.
const std::vector<std::string> directions{"higher", "lower"};
const std::vector<std::string> statuses{"changed", "unchanged", "undecided"};
const std::vector<std::string> told_words{"one", "several", "none", "unknown"};
const std::vector<std::string> why_words{"missing", "not_in_baseline", "accumulates", "no_change_to_see"};
const std::vector<std::string> like_words{"", "direction", "move", "target and direction", "move and target"};

template <class Enumeration>
std::string word_of(const std::vector<std::string>& words, Enumeration value) {
  return words[static_cast<std::size_t>(value)];
}

std::string with_unit(std::string number, const std::string& unit) {
  return unit.empty() || unit == "1" ? number : number + " " + unit;
}

/// A typical value of a measure (median, or proportion of a yes-or-no measure) as text: "0.04 s", "never"
/// (infinite) or "none" (nothing to measure); a proportion in percent.
std::string typical_text(const MeasureState& state, double value) {
  if (state.measure.quality) return text::percent_near(value);
  if (is_nothing(state.measure, value)) return "none";
  return std::isinf(value) ? "never" : with_unit(text::short_number(value), state.unit);
}

/// Typical values of a measure as text, of the log's moves and of the baseline: "0.04 s; baseline 0.05 s". If
/// classes of similar moves have medians of their own, those of the first three: "move 0: 0.04 s, baseline
/// 0.05 s; …".
std::string medians_text(const MeasureState& state) {
  constexpr std::size_t max_shown = 3;
  if (state.by_like.empty())
    return fmt::format("{}; baseline {}", typical_text(state, state.median.value_or(*state.baseline_median)),
                       typical_text(state, *state.baseline_median));
  std::vector<std::string> texts;
  for (const LikeValue& like : state.by_like)
    if (like.median)
      texts.push_back(fmt::format("{}: {}, baseline {}", like.like, typical_text(state, *like.median),
                                  typical_text(state, like.baseline)));
  if (texts.size() > max_shown) {
    texts.resize(max_shown);
    texts.emplace_back("…");
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

/// Names, separated by commas, of the watched measures whose state `is_named` accepts.
template <class IsNamed>
std::string names_of(const MonitorResult& r, IsNamed is_named) {
  std::vector<std::string> names;
  for (const MeasureState& state : r.monitor.measures())
    if (is_named(state)) names.push_back(state.measure.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

bool has_size(const MeasureState& state) {
  return !state.to_see.directions.empty();
}

/// A measure about which the status `unchanged` says nothing.
struct NotJudged {
  std::string measure;
  std::string why;  ///< Reason, one of why_words.
  /// Column with a resembling name on the side that lacks the measure; nothing if there is none.
  std::optional<std::string> near{};
};

/// The measures about which the status `unchanged` says nothing: those not watched and, if there is no alarm,
/// also watched measures for which no change to be seen could be stated.
std::vector<NotJudged> not_judged(const MonitorResult& r) {
  std::vector<NotJudged> all;
  for (const UnwatchedMeasure& one : r.monitor.unwatched())
    all.push_back({one.measure, word_of(why_words, one.why), one.near});
  if (r.state.alarm != nullptr) return all;
  for (const MeasureState& state : r.monitor.measures())
    if (!has_size(state)) all.push_back({state.measure.name, why_words.back()});
  return all;
}

/// Names of the measures that are not watched for this reason, as text: "jerk_count, arrival_time (its column
/// 'Arrival_Time' looks like it)".
std::string names_not_judged(const MonitorResult& r, WhyUnwatched why) {
  std::vector<std::string> names;
  for (const UnwatchedMeasure& one : r.monitor.unwatched())
    if (one.why == why)
      names.push_back(one.near ? fmt::format("{} (its column '{}' looks like it)", one.measure, *one.near)
                               : one.measure);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Names of the baseline's measures about which the status `unchanged` says nothing, for the headline: "; not
/// judged: jerk_count, overshoot and 3 more". Empty if all are judged.
std::string not_judged_text(const MonitorResult& r) {
  constexpr std::size_t max_shown = 3;
  std::vector<std::string> names;
  for (const NotJudged& one : not_judged(r))
    if (one.why != word_of(why_words, WhyUnwatched::not_in_baseline)) names.push_back(one.measure);
  if (names.empty()) return "";
  const std::size_t more = names.size() > max_shown ? names.size() - max_shown : 0;
  names.resize(names.size() - more);
  return fmt::format("; not judged: {}{}", fmt::join(names, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

/// Heads of the log's columns that are not measures and not used, separated by commas. A column whose name
/// resembles a measure is followed by the name of this measure.
std::string unused_columns(const MonitorResult& r) {
  std::vector<std::string> columns;
  for (const std::string& column : r.monitor.unused()) {
    if (measure_named(column_head(column).name)) continue;  // see unwatched()
    const std::optional<std::string> measure = misspelt_measure(column);
    columns.push_back(measure ? fmt::format("{} (looks like {})", column, *measure) : column);
  }
  return fmt::format("{}", fmt::join(columns, ", "));
}

/// Size of the change to be seen as text: "20 % of the baseline's median (added to each value, or as a factor
/// of it) or 0.1 of a proportion". The text has only those of its parts that apply to the judged measures.
std::string asked_change(const MonitorResult& r) {
  const std::optional<double>& size = r.monitor.settings().change;
  bool any_proportion = false;
  bool any_other = false;
  for (const MeasureState& state : r.monitor.measures()) {
    const bool is_proportion = state.measure.scale == Scale::proportion;
    any_proportion = any_proportion || (has_size(state) && is_proportion);
    any_other = any_other || (has_size(state) && !is_proportion);
  }
  std::vector<std::string> parts;
  if (any_other || !any_proportion)
    parts.push_back(fmt::format("{} of the baseline's median (added to each value, or as a factor of it)",
                                text::percent(size.value_or(0.2))));
  if (any_proportion) parts.push_back(fmt::format("{:g} of a proportion", size.value_or(0.1)));
  return fmt::format("{}", fmt::join(parts, " or "));
}

std::string headline_of(const MonitorResult& r) {
  if (const MeasureState* const alarm = r.state.alarm)
    return fmt::format("changed: {} is {} since move {} ({}); alarm at move {} of {}", alarm->measure.name,
                       word_of(directions, *alarm->direction), *alarm->since, medians_text(*alarm),
                       *alarm->alarm_at, r.state.moves);
  if (r.state.status == MachineStatus::unchanged)
    return fmt::format(
        "unchanged: no alarm in {} moves, in which a change of {} would have been seen with 90 % in {}{}",
        r.state.moves, asked_change(r), names_of(r, has_size), not_judged_text(r));
  if (r.state.moves == 0) return "undecided: there are no moves yet";
  if (r.monitor.values() == 0 && r.monitor.unlike() > 0)
    return fmt::format("undecided: none of {} moves is like one of the baseline; the first is {}",
                       r.state.moves, text::printable(r.monitor.first_unlike()));
  if (r.monitor.values() == 0)
    return fmt::format("undecided: no {} of moves is complete after {} moves",
                       r.monitor.settings().group.empty() ? "block" : "group", r.state.moves);
  const std::string unseen = names_of(r, [](const MeasureState& s) { return has_size(s) && !s.seen_after; });
  return fmt::format("undecided: no alarm in {} moves, but a change of {} need not have been seen{}",
                     r.state.moves, asked_change(r),
                     unseen.empty() ? ": no measure has a size of change to be seen" : " in " + unseen);
}

/// A change of a parameter as text: "friction.k1 lower by 12 to 20 %", "encoder.fine_errors.noise higher by
/// 0.08 to 0.12 count". If the interval reaches the largest simulated change, the text is "lower by at least
/// 12 %".
std::string change_text(const ParameterChange& change) {
  const bool is_factor = change.kind == ChangeKind::factor;
  const auto off = [&](double end) {
    return fmt::format("{:.2g}", is_factor ? 100.0 * std::abs(end - 1.0) : std::abs(end));
  };
  const std::string unit = is_factor ? "%" : change.unit;
  const bool lower = change.high <= unchanged_by(change.kind);
  if (!lower && change.low < unchanged_by(change.kind))
    return fmt::format("{} between {} lower and {} higher", change.parameter,
                       with_unit(off(change.low), unit), with_unit(off(change.high), unit));
  const std::string least = off(lower ? change.high : change.low);
  const std::string most = off(lower ? change.low : change.high);
  const bool beyond = lower ? change.beyond_low : change.beyond_high;
  return fmt::format("{} {} by {}", change.parameter, lower ? "lower" : "higher",
                     with_unit(beyond ? "at least " + least : least + " to " + most, unit));
}

/// Parameters that were not tried as explanation because the budget of trials was used up, as text: "; the
/// budget ended before a, b and 20 more were tried: all parameters take at most 20000 trials, …". Empty if
/// all were tried.
std::string untried_text(const ChangeExplanation& explanation) {
  if (explanation.untried.empty()) return "";
  constexpr std::size_t max_shown = 3;
  const std::size_t shown = std::min(max_shown, explanation.untried.size());
  const std::size_t more = explanation.untried.size() - shown;
  return fmt::format(
      "; the budget ended before {}{} {} tried: all parameters take at most {} trials, expected a --budget "
      "of as many, a time such as 10min, or --unchanged with what cannot have changed",
      fmt::join(std::span(explanation.untried).first(shown), ", "),
      more > 0 ? fmt::format(" and {} more", more) : "", shown + more == 1 ? "was" : "were",
      explanation.max_trials);
}

std::string explanation_text(const ChangeExplanation& explanation) {
  if (explanation.told == ExplanationKind::unknown)
    return "it is unknown which parameter changed: " + explanation.reason + untried_text(explanation);
  const std::string since =
      explanation.since > 1
          ? fmt::format("since move {}, compared with the machine's own moves before", explanation.since)
          : std::string("compared with the simulated machines, from the first move on");
  if (explanation.told == ExplanationKind::none)
    return fmt::format(
        "no single parameter of those tried explains these moves (the misfit of the nearest is {:.1f} times "
        "its 99 % limit); {}{}",
        explanation.misfit / explanation.max_misfit, since, untried_text(explanation));
  std::vector<std::string> texts;
  for (const ParameterChange& change : explanation.parameters)
    texts.push_back(fmt::format("{} ({})", change_text(change), text::percent_near(change.probability)));
  return fmt::format("{} {}; {}{}",
                     explanation.told == ExplanationKind::one
                         ? "if one parameter of the model differs, it is"
                         : "these measures do not show which parameter differs:",
                     fmt::join(texts, ", or "), since, untried_text(explanation));
}

/// Notes on the answer, one per line: the explanation of the alarm, what was not compared, and the
/// assumptions under which the answer holds.
std::string notes_of(const MonitorResult& r) {
  const MachineMonitor& monitor = r.monitor;
  const MonitorSettings& settings = monitor.settings();
  const Likes& likes = monitor.likes();
  const bool grouped = !settings.group.empty();
  std::vector<std::string> notes;
  const auto note = [&](std::string_view begin, const std::string& names, const std::string& end = {}) {
    if (!names.empty()) notes.push_back(fmt::format("{}{}{}", begin, text::printable(names), end));
  };
  if (r.explanation != nullptr) notes.push_back(explanation_text(*r.explanation));
  if (r.state.alarm == nullptr)
    note(
        "not judged, because the median is 0 or infinite, values have both signs, or a proportion cannot "
        "change so much: ",
        names_of(r, [](const MeasureState& s) { return !has_size(s); }));
  note(fmt::format("not judged, because {} has no such column: ", text::printable(r.log)),
       names_not_judged(r, WhyUnwatched::missing));
  note("not judged, because the baseline has no such column: ",
       names_not_judged(r, WhyUnwatched::not_in_baseline));
  note("not judged, because the value grows from move to move (--measure judges it all the same): ",
       names_not_judged(r, WhyUnwatched::accumulates));
  note("columns that are not compared: ", unused_columns(r));
  for (const UnwatchedMeasure& label : monitor.unused_labels())
    notes.push_back(text::printable(
        fmt::format("moves are not compared with those of the same {}, because {} has no such column{}",
                    label.measure, label.why == WhyUnwatched::missing ? r.log : r.baseline.name,
                    label.near ? fmt::format("; its column '{}' looks like it", *label.near) : "")));
  if (r.repeated > 0)
    notes.push_back(fmt::format(
        "the first {} of these moves have the same values as those of the baseline: if they are the same "
        "moves, they show nothing about a change",
        r.repeated));
  if (likes.count() > 1) {
    notes.push_back(fmt::format("moves are compared with those of the same {} ({} in the baseline)",
                                word_of(like_words, likes.by()), likes.count()));
    note(likes.takes_magnitudes() ? "by magnitude: " : "by the direction of the move: ",
         names_of(r, [](const MeasureState& s) { return s.measure.row->values.mirrored; }));
  }
  if (monitor.unlike() > 0)
    notes.push_back(
        fmt::format("moves of a kind that the baseline lacks, which are not compared: {}; the first: {}",
                    monitor.unlike(), text::printable(monitor.first_unlike())));
  if (monitor.continued() > 0)
    notes.push_back(fmt::format("moves of the last group of the baseline, which are not compared: {}",
                                monitor.continued()));
  const std::string values = grouped               ? "groups of " + text::printable(settings.group)
                             : settings.block == 1 ? "moves"
                                                   : fmt::format("blocks of {} moves", settings.block);
  notes.push_back(fmt::format(
      "a false alarm within any number of moves has at most the probability {}, where the {} are "
      "exchangeable with those of the same kind in the baseline ({})",
      text::percent(settings.alarm), values, grouped ? monitor.baseline_values() : r.baseline.moves));
  std::int64_t over = 0;
  std::vector<std::string> resembling, alternating;
  for (const MeasureState* const state : monitor.dependent()) {
    (state->dependence.alternates ? alternating : resembling).push_back(state->measure.name);
    if (!state->dependence.alternates) over = std::max(over, state->dependence.over);
  }
  note("in the baseline neighbours resemble each other in ", fmt::format("{}", fmt::join(resembling, ", ")),
       fmt::format(", over some {} {}, so that they are not exchangeable: false alarms are more frequent; {} "
                   "makes them rarer",
                   over, values,
                   grouped ? "a column of larger groups"
                           : "a column of what neighbours have in common, such as the day (--group), or a "
                             "longer --block"));
  note("in the baseline neighbours differ more than others in ",
       fmt::format("{}", fmt::join(alternating, ", ")),
       ", as if moves of several kinds alternated: with a column 'move' or 'target' in both files, only "
       "moves of the same kind are compared");
  if (r.baseline.is_model)
    notes.push_back(fmt::format(
        "the baseline is a model of {} machine{}: an alarm can mean that the model is wrong, or that this "
        "machine is not an average one, not that it changed; to see whether it changed, take its own first "
        "moves as the baseline",
        r.baseline.machines, r.baseline.machines == 1 ? "" : "s"));
  return fmt::format("{}", fmt::join(notes, "\n"));
}

document::Item number(std::string key, std::string heading, std::string meaning,
                      Notation notation = Notation::four_digits, std::string unit = {}) {
  document::Item item = everywhere(std::move(key), std::move(heading), std::move(meaning), std::move(unit));
  item.notation = notation;
  return item;
}

Description<MeasureState> measure_description() {
  using State = const MeasureState&;
  const auto shown = [](std::optional<double> MeasureState::*member) {
    return [member](State s) -> std::string {
      if (!(s.*member)) return "–";
      return s.measure.quality ? text::percent_near(*(s.*member)) : text::short_number(*(s.*member));
    };
  };
  const auto right = [](const char* key, const char* heading, const char* meaning) {
    document::Item item = everywhere(key, heading, meaning);
    item.numeric = true;  // the table aligns these texts as numbers
    return item;
  };
  return Description<MeasureState>()
      .value(everywhere("measure", "measure", "name of the measure"), [](State s) { return s.measure.name; })
      .value(everywhere("unit", "unit", "its unit"), &MeasureState::unit)
      .value(
          right(
              "baseline", "baseline",
              "median of the baseline, of a quality its proportion; null: never, or one for each like: see `likes`"),
          &MeasureState::baseline_median)
      .shown_as(shown(&MeasureState::baseline_median))
      .value(right("moves", "moves",
                   "median of the moves, of a quality its proportion, since the change if there is one; "
                   "null: none, or never"),
             &MeasureState::median)
      .shown_as(shown(&MeasureState::median))
      .value(number("evidence", "evidence",
                    "largest capital of the bets on a change of the measure, as a part of the alarm's scale",
                    Notation::three_digits, "1"),
             &MeasureState::evidence)
      .value(with_words(everywhere("direction", "direction", "direction of the change; null: no alarm"),
                        directions),
             [](State s) {
               return s.direction ? std::optional(word_of(directions, *s.direction)) : std::nullopt;
             })
      .value(everywhere("since", "since", "first move of the change, from 1; null: no alarm"),
             &MeasureState::since)
      .value(everywhere("alarm_at", "alarm at", "move of the alarm, from 1; null: none"),
             &MeasureState::alarm_at)
      .value(in_data("correlation",
                     "rank correlation of successive values of the baseline; null: of a simulated one", "1"),
             &MeasureState::correlation)
      .value(
          in_data(
              "dependence",
              "p-value of the order of the baseline's values, if they are exchangeable; null: of a simulated one",
              "1"),
          [](State s) { return s.correlation ? std::optional(s.dependence.p) : std::nullopt; })
      .value(
          everywhere(
              "seen_after", "seen after",
              "moves after which a change of the asked size, added to each value or as a factor of it, would have been seen with 90 %, where there are as many; "
              "null: later, or not asked"),
          &MeasureState::seen_after);
}

Description<NotJudged> not_judged_description() {
  return Description<NotJudged>()
      .value(in_data("measure", "name of the measure"), &NotJudged::measure)
      .value(with_words(
                 in_data("why",
                         "missing: the moves have no such column; not_in_baseline: the baseline has none; "
                         "accumulates: it grows from move to move, and --measure does not name it; "
                         "no_change_to_see: it has no size of change, see `change`"),
                 why_words),
             &NotJudged::why)
      .value(in_data("near", "column of the side that lacks the measure whose name resembles it; null: none"),
             &NotJudged::near);
}

Description<LikeValue> like_description() {
  return Description<LikeValue>()
      .value(everywhere("measure", "measure", "name of the measure"), &LikeValue::measure)
      .value(everywhere("like", "moves like", "what these moves have in common"), &LikeValue::like)
      .value(number("baseline", "baseline", "their median in the baseline; null: never"),
             &LikeValue::baseline)
      .value(everywhere("baseline_moves", "of", "number of moves of that median"), &LikeValue::baseline_moves)
      .value(number("median", "moves",
                    "their median in the log, since the change if there is one; null: none, or never"),
             &LikeValue::median)
      .value(everywhere("moves", "of", "number of moves of that median"), &LikeValue::moves);
}

Description<ParameterChange> parameter_description() {
  Description<ParameterChange> description;
  description.value(everywhere("parameter", "parameter", "dotted path"), &ParameterChange::parameter);
  const auto add = [&](ChangeKind kind, double ParameterChange::*member, const char* key, const char* heading,
                       const char* meaning) {
    description.value(number(key, heading, meaning, Notation::three_digits),
                      [=](const ParameterChange& change) {
                        return change.kind == kind ? std::optional(change.*member) : std::nullopt;
                      });
  };
  using enum ChangeKind;
  add(factor, &ParameterChange::change, "factor", "times",
      "most likely factor by which it changed; null: something was added");
  add(factor, &ParameterChange::low, "low", "from", "low end of the 95 % interval of the factor");
  add(factor, &ParameterChange::high, "high", "to", "high end of it");
  add(amount, &ParameterChange::change, "amount", "plus",
      "most likely amount that was added, in its unit; null: it was multiplied");
  add(amount, &ParameterChange::low, "amount_low", "from", "low end of the 95 % interval of the amount");
  add(amount, &ParameterChange::high, "amount_high", "to", "high end of it");
  return description.value(
      number("probability", "probability", "that it is this parameter, if it is one of those tried",
             Notation::percent, "1"),
      &ParameterChange::probability);
}

std::vector<LikeValue> like_values(const MonitorResult& r) {
  std::vector<LikeValue> all;
  for (const MeasureState& state : r.monitor.measures())
    all.insert(all.end(), state.by_like.begin(), state.by_like.end());
  return all;
}

/// Output items (for text and JSON) that describe the first alarm: its measure, the direction and estimated
/// time of the change, and the move at which the alarm came.
Description<MeasureState> alarm_description() {
  using State = const MeasureState&;
  return Description<MeasureState>()
      .value(in_data("measure", "measure of the first alarm; null: none"),
             [](State s) { return s.measure.name; })
      .value(with_words(in_data("direction", "direction of its change; null: no alarm"), directions),
             [](State s) { return word_of(directions, *s.direction); })
      .value(in_data("since", "estimated first move of the change, from 1; null: no alarm"),
             [](State s) { return *s.since; })
      .value(in_data("alarm_at", "move of the alarm, from 1; null: none"),
             [](State s) { return *s.alarm_at; });
}

/// Output items (for text and JSON) on the parameters of the simulated study whose change may explain the
/// alarm.
Description<ChangeExplanation> explanation_description() {
  return Description<ChangeExplanation>()
      .value(
          with_words(
              in_data("told", "what is known of the parameters of the model after an alarm; null: not asked"),
              told_words),
          [](const ChangeExplanation& e) { return word_of(told_words, e.told); })
      .value(in_data("parameters_since",
                     "first move of those that the parameters explain, from 1; null: not asked"),
             &ChangeExplanation::since);
}

}  // namespace

document::AnswerDescription<MonitorResult> monitor_answer() {
  document::AnswerDescription<MonitorResult> answer{
      {.name = "monitor", .meaning = "whether a machine has changed", .csv_table = "measures"}, {}};
  answer.items.headline(headline_of)
      .value(with_words(in_data("status", "whether the machine changed"), statuses),
             [](const MonitorResult& r) { return word_of(statuses, r.state.status); })
      .include(alarm_description(), [](const MonitorResult& r) { return r.state.alarm; })
      .value(in_data("moves", "moves seen"), [](const MonitorResult& r) { return r.state.moves; })
      .value(in_data("evidence", "e-value against no change, the largest until now; the alarm is at 1/alarm",
                     "1"),
             [](const MonitorResult& r) { return r.state.evidence; })
      .value(in_data("alarm", "largest probability of a false alarm within any number of moves", "1"),
             [](const MonitorResult& r) { return r.monitor.settings().alarm; })
      .value(in_data("block", "consecutive moves that are one value"),
             [](const MonitorResult& r) { return r.monitor.settings().block; })
      .value(in_data("group", "column of the groups that are one value each; null: none"),
             [](const MonitorResult& r) {
               const std::string& group = r.monitor.settings().group;
               return group.empty() ? std::nullopt : std::optional(group);
             })
      .value(in_data("values", "values that were compared: moves, blocks or groups"),
             [](const MonitorResult& r) { return r.monitor.values(); })
      .value(in_data("baseline", "file of the baseline"),
             [](const MonitorResult& r) { return r.baseline.name; })
      .value(in_data("log", "file of the moves"), &MonitorResult::log)
      .value(in_data("baseline_moves", "moves of the baseline"),
             [](const MonitorResult& r) { return r.baseline.moves; })
      .value(in_data("baseline_machines", "simulated machines of the baseline; null: it was measured"),
             [](const MonitorResult& r) {
               return r.baseline.is_model ? std::optional(r.baseline.machines) : std::nullopt;
             })
      .value(in_data("repeated",
                     "first moves that have the same values as the first ones of a measured baseline"),
             &MonitorResult::repeated)
      .value(in_data("unused", "columns of the moves that nothing is compared with"),
             [](const MonitorResult& r) { return r.monitor.unused(); })
      .value(in_data("alike", "what moves are compared by; empty: all with all"),
             [](const MonitorResult& r) { return word_of(like_words, r.monitor.likes().by()); })
      .value(in_data("unlike", "moves that the baseline has none like, which are not compared"),
             [](const MonitorResult& r) { return r.monitor.unlike(); })
      .table({.key = "measures", .meaning = "each measure"}, measure_description(),
             [](const MonitorResult& r) { return r.monitor.measures(); })
      .table({.key = "not_judged",
              .meaning = "measures about which 'unchanged' says nothing",
              .shown = document::Visibility::in_json},
             not_judged_description(), not_judged)
      .table(
          {.key = "likes",
           .meaning = "medians of measures that differ from one kind of moves to another more than within"},
          like_description(), like_values)
      .include(explanation_description(), [](const MonitorResult& r) { return r.explanation; })
      .value(in_data("tried", "parameters of the model that were tried and act on the measures"),
             [](const MonitorResult& r) {
               return r.explanation ? r.explanation->tried : std::vector<std::string>{};
             })
      .value(in_data("untried", "parameters for which the budget did not suffice"),
             [](const MonitorResult& r) {
               return r.explanation ? r.explanation->untried : std::vector<std::string>{};
             })
      .table({.key = "parameters", .meaning = "parameters of the model that explain the change"},
             parameter_description(),
             [](const MonitorResult& r) {
               return r.explanation ? r.explanation->parameters : std::vector<ParameterChange>{};
             })
      .sentence(notes_of);
  return answer;
}

ExitCode exit_code_of(MachineStatus status) {
  return status == MachineStatus::changed     ? ExitCode::regression
         : status == MachineStatus::unchanged ? ExitCode::success
                                              : ExitCode::inconclusive;
}

}  // namespace zerocount::monitor
