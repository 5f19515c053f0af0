#include "results/layout/layout.hpp"

#include <algorithm>
#include <iterator>
#include <type_traits>

namespace zerocount {
namespace {

template <class Value>
constexpr Element element_of() {
  if constexpr (std::is_same_v<Value, double>) return Element::float64;
  if constexpr (std::is_same_v<Value, std::int64_t>) return Element::int64;
  if constexpr (std::is_same_v<Value, int>) return Element::int32;
  if constexpr (std::is_same_v<Value, bool>) return Element::flag;
  return Element::int8;
}

template <class Record, class Owner, class Value>
RecordField<Record> field(const char* name, const char* unit, const char* long_name, Value Owner::*member,
                          std::vector<FlagMeaning> flags = {}) {
  if constexpr (std::is_same_v<Value, bool>) flags = {{0, "no"}, {1, "yes"}};
  return {Column{name, unit, long_name, element_of<Value>(), std::move(flags), {}},
          static_cast<Value Record::*>(member)};
}

std::vector<FlagMeaning> mode_words() {
  return {{static_cast<int>(HookMode::stick), "stick"}, {static_cast<int>(HookMode::slide), "slide"}};
}

Column whole_numbers(const char* name, const char* long_name) {
  return {name, "1", long_name, Element::int64, {}, {}};
}

template <class Record>
std::vector<Column> columns_of(const std::vector<RecordField<Record>>& fields) {
  std::vector<Column> columns;
  std::transform(fields.begin(), fields.end(), std::back_inserter(columns),
                 [](const RecordField<Record>& entry) { return entry.column; });
  return columns;
}

}  // namespace

std::vector<FlagMeaning> outcome_words() {
  return {{static_cast<int>(Outcome::zero_count), "zero_count"},
          {static_cast<int>(Outcome::one_count), "one_count"},
          {static_cast<int>(Outcome::oscillating), "oscillating"},
          {static_cast<int>(Outcome::nonfinite), "nonfinite"}};
}

std::string word_of(const Column& column, std::int64_t value) {
  const auto flag = std::find_if(column.flags.begin(), column.flags.end(),
                                 [value](const FlagMeaning& meaning) { return meaning.value == value; });
  return flag == column.flags.end() ? std::to_string(value) : flag->word;
}

const std::vector<RecordField<MoveOutcome>>& outcome_fields() {
  using M = MoveOutcome;
  static const std::vector<RecordField<M>> fields{
      field<M>("outcome", "1", "verdict on the last window of the move", &M::outcome, outcome_words()),
      field<M>("arrived", "1", "the error was 0 for a whole dwell", &M::arrived),
      field<M>("arrival", "1", "first sample of the arrival dwell from the start of the move, -1 if never",
               &M::arrival),
      field<M>("settling_time", "s", "time of arrival from the start of the move, NaN if never",
               &M::settling_time),
      field<M>("stable", "1", "arrived, and the error within one count from then to the end", &M::stable),
      field<M>("broke_away", "1", "the hook slid during the move", &M::broke_away),
      field<M>("saturated", "1", "the DAC clipped", &M::saturated),
      field<M>("overshoot", "count",
               "largest excursion beyond the target, seen from the first count of the move", &M::overshoot),
      field<M>("holding_torque", "N m", "torque decided at the last sample", &M::holding_torque),
      field<M>("peak_torque", "N m", "largest absolute torque decided", &M::peak_torque),
      field<M>("creep", "rad", "plastic extension xp at the last sample", &M::creep),
      field<M>("final_position", "rad", "rotor angle at the last sample", &M::final_position),
      field<M>("reversal_depth", "1", "largest number of reversal points on the stack", &M::reversal_depth),
      field<M>("jerk_count", "1", "excursions of the error from zero after arrival", &M::jerk_count),
      field<M>("jerk_agreement", "1",
               "share of the jerks in the direction of the holding torque, NaN if none", &M::jerk_agreement)};
  return fields;
}

const std::vector<RecordField<JerkRecord>>& jerk_fields() {
  using J = JerkRecord;
  static const std::vector<RecordField<J>> fields{
      field<J>("trial", "1", "global row of the trial", &J::trial),
      field<J>("move", "1", "index of the move", &J::move),
      field<J>("onset", "s", "first sample with an error, from the start of the move", &J::onset),
      field<J>("duration", "s", "time with an error, cut at the end of the move", &J::duration),
      field<J>("magnitude", "count", "largest absolute error", &J::magnitude),
      field<J>("direction", "1", "sign of count minus target at onset", &J::direction)};
  return fields;
}

const std::vector<RecordField<TraceRecord>>& trace_fields() {
  using T = TraceRecord;
  static const std::vector<RecordField<T>> fields{
      field<T>("trial", "1", "global row of the trial", &T::trial),
      field<T>("k", "1", "sample number from the start of the trial", &T::k),
      field<T>("t", "s", "time of the sampling instant from the start of the trial", &T::t),
      field<T>("target", "count", "commanded position", &T::target),
      field<T>("count", "count", "reading of the fine encoder", &T::count),
      field<T>("coarse_count", "count", "reading of the coarse encoder", &T::coarse_count),
      field<T>("error", "count", "target minus count", &T::error),
      field<T>("code", "1", "DAC code decided at this instant", &T::code),
      field<T>("torque", "N m", "torque decided at this instant", &T::torque),
      field<T>("theta", "rad", "rotor angle", &T::theta),
      field<T>("omega", "rad/s", "rotor velocity", &T::omega),
      field<T>("xp", "rad", "plastic extension", &T::xp),
      field<T>("xh", "rad", "hardening", &T::xh),
      field<T>("depth", "1", "reversal points on the stack", &T::depth),
      field<T>("mode", "1", "whether the hook sticks or slides", &T::mode, mode_words())};
  return fields;
}

Table point_table(const std::vector<SweepAxis>& axes, const std::vector<PointColumn>& statistics) {
  Table table{"point", whole_numbers("point", "index of the design point"), {}, {}};
  table.columns.push_back({"label", "1", "name of the design point", Element::text, {}, {}});
  for (const SweepAxis& axis : axes) {
    const bool text = axis.kind == SweepAxis::Kind::text;
    table.columns.push_back({axis.name,
                             text || axis.unit.empty() ? "1" : axis.unit,
                             axis.meaning,
                             text ? Element::text : Element::float64,
                             {},
                             "axis"});
  }
  for (const PointColumn& statistic : statistics) {
    table.columns.push_back(
        {statistic.name, statistic.unit, statistic.long_name, Element::float64, {}, "statistic"});
  }
  return table;
}

std::string input_column_name(const std::string& parameter) {
  return "input/" + parameter;
}

Table trial_table(const std::vector<InputColumn>& inputs) {
  Table table{
      "trial", whole_numbers("trial", "global row of the trial, point times trials plus index"), {}, {}};
  table.columns.push_back(whole_numbers("point", "index of the design point"));
  table.columns.push_back(whole_numbers("index", "index of the trial within its design point"));
  for (const InputColumn& input : inputs) {
    table.columns.push_back(
        {input_column_name(input.name), input.unit, input.meaning, Element::float64, {}, {}});
  }
  return table;
}

Table outcome_table() {
  return {"outcome", whole_numbers("trial", "global row of the trial"),
          whole_numbers("move", "index of the move"), columns_of(outcome_fields())};
}

Table jerk_table() {
  return {"jerk",
          whole_numbers("jerk", "index of the jerk, by trial, move and onset"),
          {},
          columns_of(jerk_fields())};
}

Table trace_table() {
  return {"trace",
          whole_numbers("record", "index of the record, by trial and sample"),
          {},
          columns_of(trace_fields())};
}

Table profile_table(const std::string& name, const std::string& unit) {
  return {"profile/" + name,
          {"theta", "rad", "rotor angle from the origin of the profile", Element::float64, {}, {}},
          {},
          {{"value", unit, "realised value of " + name, Element::float64, {}, {}}}};
}

}  // namespace zerocount
