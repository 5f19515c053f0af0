#include "results/layout/layout.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>
#include <utility>

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

/// A column that the layout has since `version`; `before` is its value in files that lack it.
template <class Record>
RecordField<Record> since(std::int64_t version, double before, RecordField<Record> added) {
  added.since = version;
  added.before = before;
  return added;
}

std::vector<FlagMeaning> mode_words() {
  return {{static_cast<int>(HookMode::stick), "stick"}, {static_cast<int>(HookMode::slide), "slide"}};
}

std::vector<FlagMeaning> phase_words() {
  return {{static_cast<int>(ControlPhase::fine), "fine"}, {static_cast<int>(ControlPhase::coarse), "coarse"}};
}

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::vector<RecordField<MoveOutcome>> all_outcome_fields() {
  using M = MoveOutcome;
  return {
      field<M>("outcome", "1", "verdict on the last window of the move", &M::outcome, outcome_labels()),
      field<M>("arrived", "1", "the error was 0 for a whole dwell", &M::arrived),
      field<M>("arrival", "1", "first sample of the arrival dwell from the start of the move, -1 if never",
               &M::arrival),
      field<M>("settling_time", "s", "time of arrival from the start of the move, NaN if never",
               &M::settling_time),
      since(3, unknown,
            field<M>("final_settling_time", "s",
                     "time from which the error is 0 to the end, from the start of the move, NaN if none",
                     &M::final_settling_time)),
      since(3, unknown,
            field<M>("zero_fraction", "1",
                     "fraction of the samples from arrival to the end with an error of 0, NaN if never "
                     "arrived",
                     &M::zero_fraction)),
      field<M>("stable", "1", "arrived, and the error within one count from then to the end", &M::stable),
      field<M>("broke_away", "1", "the hook slid during the move", &M::broke_away),
      field<M>("saturated", "1", "the DAC clipped", &M::saturated),
      field<M>("overshoot", "count",
               "largest excursion beyond the target, seen from the first count of the move", &M::overshoot),
      field<M>("holding_torque", "N m", "torque decided at the last sample", &M::holding_torque),
      field<M>("peak_torque", "N m", "largest absolute torque decided", &M::peak_torque),
      field<M>("creep", "rad", "plastic extension xp at the last sample", &M::creep),
      field<M>("final_position", "rad", "rotor angle at the last sample", &M::final_position),
      since(
          3, unknown,
          field<M>("midway_error", "count",
                   "target minus count at the first sample of the last half of the move", &M::midway_error)),
      since(2, unknown,
            field<M>("final_error", "count", "target minus count at the last sample", &M::final_error)),
      since(2, unknown,
            field<M>("true_error", "count",
                     "distance from the rotor to the middle of the target's count at the last sample, "
                     "NaN if none",
                     &M::true_error)),
      since(2, 0.0,
            field<M>("travel_time", "s", "time until the reference or the torque is where it is held",
                     &M::travel_time)),
      since(2, 0.0,
            field<M>("phase_changes", "1", "changes of the control from coarse to fine or back",
                     &M::phase_changes)),
      since(2, 0.0,
            field<M>("encoder_disagreement", "1",
                     "samples at which the fine count made the coarse one impossible",
                     &M::encoder_disagreement)),
      since(3, unknown,
            field<M>("oscillation_amplitude", "count",
                     "half of the largest minus the smallest count in the last half of an oscillating move, "
                     "NaN of others",
                     &M::oscillation_amplitude)),
      since(
          3, unknown,
          field<M>("oscillation_period", "s",
                   "mean time between upward crossings of the middle of these counts, NaN if fewer than two",
                   &M::oscillation_period)),
      field<M>("reversal_depth", "1", "largest number of reversal points on the stack", &M::reversal_depth),
      field<M>("jerk_count", "1", "excursions of the error from zero after arrival", &M::jerk_count),
      field<M>("jerk_agreement", "1",
               "proportion of the jerks in the direction of the holding torque, NaN if none",
               &M::jerk_agreement)};
}

std::vector<RecordField<MoveOutcome>> outcome_fields_of(std::int64_t version, const OutcomeExtras& extras) {
  std::vector<RecordField<MoveOutcome>> fields = all_outcome_fields();
  std::erase_if(fields, [version](const auto& entry) { return entry.since > version; });
  if (extras.stopped) {
    fields.push_back(field<MoveOutcome>(
        "stopped", "1", "the move had diverged and was ended there, or was not run after one that was",
        &MoveOutcome::stopped));
  }
  return fields;
}

}  // namespace

std::vector<FlagMeaning> outcome_labels() {
  return {{static_cast<int>(Outcome::zero_count), "zero_count"},
          {static_cast<int>(Outcome::one_count), "one_count"},
          {static_cast<int>(Outcome::oscillating), "oscillating"},
          {static_cast<int>(Outcome::nonfinite), "nonfinite"},
          {static_cast<int>(Outcome::open_loop), "open_loop"},
          {static_cast<int>(Outcome::off_target), "off_target"}};
}

Outcome outcome_in_version(std::int64_t version, Outcome outcome) {
  return version < 3 && outcome == Outcome::off_target ? Outcome::oscillating : outcome;
}

std::string word_of(const Column& column, std::int64_t value) {
  const auto flag = std::find_if(column.flags.begin(), column.flags.end(),
                                 [value](const FlagMeaning& meaning) { return meaning.value == value; });
  return flag == column.flags.end() ? std::to_string(value) : flag->word;
}

const std::vector<RecordField<MoveOutcome>>& outcome_fields(std::int64_t version,
                                                            const OutcomeExtras& extras) {
  using Fields = std::vector<RecordField<MoveOutcome>>;
  static const std::vector<std::array<Fields, 2>> of_versions = [] {
    std::vector<std::array<Fields, 2>> versions;
    for (std::int64_t v = 1; v <= format_version; ++v)
      versions.push_back({outcome_fields_of(v, {false}), outcome_fields_of(v, {true})});
    return versions;
  }();
  return of_versions.at(static_cast<std::size_t>(version - 1))[extras.stopped ? 1 : 0];
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

std::vector<RecordField<TraceRecord>> trace_fields(const TraceExtras& extras) {
  using T = TraceRecord;
  std::vector<RecordField<T>> fields{
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
  if (extras.reference)
    fields.push_back(field<T>("reference", "count", "position that the control follows", &T::reference));
  if (extras.phase) {
    fields.push_back(
        field<T>("phase", "1", "phase of the control at this instant", &T::phase, phase_words()));
  }
  if (extras.drive_torque) {
    fields.push_back(
        field<T>("drive_torque", "N m", "torque of the motor at this instant", &T::drive_torque));
  }
  return fields;
}

}  // namespace zerocount
