#include "results/layout/layout.hpp"

#include <algorithm>

#include "results/layout/fields.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::layout {
namespace {

std::vector<FlagMeaning> mode_labels() {
  return {{static_cast<int>(trial::HookMode::stick), "stick"},
          {static_cast<int>(trial::HookMode::slide), "slide"}};
}

std::vector<FlagMeaning> phase_words() {
  return {{static_cast<int>(loop::ControlPhase::fine), "fine"},
          {static_cast<int>(loop::ControlPhase::coarse), "coarse"}};
}

constexpr ValidValues a_time{"a finite time, not negative"};

}  // namespace

std::vector<FlagMeaning> outcome_labels() {
  return {{static_cast<int>(trial::Outcome::zero_count), "zero_count"},
          {static_cast<int>(trial::Outcome::one_count), "one_count"},
          {static_cast<int>(trial::Outcome::oscillating), "oscillating"},
          {static_cast<int>(trial::Outcome::nonfinite), "nonfinite"},
          {static_cast<int>(trial::Outcome::open_loop), "open_loop"},
          {static_cast<int>(trial::Outcome::off_target), "off_target"}};
}

std::string value_text(const Column& column, std::int64_t value) {
  const auto flag = std::find_if(column.flags.begin(), column.flags.end(),
                                 [value](const FlagMeaning& meaning) { return meaning.value == value; });
  return flag == column.flags.end() ? std::to_string(value) : flag->word;
}

std::vector<RecordField<trial::MoveOutcome>> outcome_fields(const study::StudyFeatures& features,
                                                            const MeasureTable& measures) {
  std::vector<RecordField<trial::MoveOutcome>> fields;
  for (const Measure& measure : measures) {
    if (is_in_file(measure, features)) fields.push_back(measure.field);
  }
  return fields;
}

std::vector<RecordField<trial::MoveOutcome>> move_fields(const study::StudyFeatures& features,
                                                         const MeasureTable& measures) {
  std::vector<RecordField<trial::MoveOutcome>> fields;
  for (const Measure& measure : measures) {
    if (!measure.band && !measure.tolerance && is_in_file(measure, features)) fields.push_back(measure.field);
  }
  return fields;
}

const std::vector<RecordField<trial::BandOutcome>>& band_fields() {
  using B = trial::BandOutcome;
  constexpr ValidValues a_time_or_nan{.expected = "a finite time, not negative, or NaN", .nan = true};
  static const std::vector<RecordField<B>> fields{
      field<B>("band_entry_time", "s",
               "time of the first dwell within the error band from the start of the move, NaN if never",
               &B::entry_time, a_time_or_nan),
      field<B>(
          "band_settling_time", "s",
          "time from which the error is within the band to the end, from the start of the move, NaN if it ends outside",
          &B::settling_time, a_time_or_nan),
      field<B>("band_exits", "1", "times that the error left the band after the first dwell within it",
               &B::exits, {.expected = "a count, or NaN", .nan = true})};
  return fields;
}

std::vector<RecordField<ToleranceRecord>> tolerance_fields(const study::StudyFeatures& features) {
  const auto field_of = [](const std::string& mass, double ToleranceRecord::*member) {
    RecordField<ToleranceRecord> one = field<ToleranceRecord>(
        "tolerance_settling_time", "s",
        "time from which the position error is within the tolerance to the end, from the start of the move, NaN if it ends outside",
        member, {.expected = "a finite time, not negative, or NaN", .nan = true});
    if (mass.empty()) return one;
    one.column.name = mass + "_" + one.column.name;
    one.column.long_name += ", of the " + mass;
    return one;
  };
  std::vector<RecordField<ToleranceRecord>> fields{field_of("", &ToleranceRecord::settling_time)};
  if (features.load_error) fields.push_back(field_of("load", &ToleranceRecord::other_settling_time));
  if (features.motor_error) fields.push_back(field_of("motor", &ToleranceRecord::other_settling_time));
  return fields;
}

const std::vector<RecordField<JerkRecord>>& jerk_fields() {
  using J = JerkRecord;
  static const std::vector<RecordField<J>> fields{
      field<J>("trial", "1", "global row of the trial", &J::trial),
      field<J>("move", "1", "index of the move", &J::move),
      field<J>("onset", "s", "first sample with an error, from the start of the move", &J::onset, a_time),
      field<J>("duration", "s", "time with an error, cut at the end of the move", &J::duration, a_time),
      field<J>("magnitude", "count", "largest absolute error", &J::magnitude, {"a count, not negative"}),
      field<J>("direction", "1", "sign of count minus target at onset", &J::direction,
               {"-1, 0 or 1", -1, 1})};
  return fields;
}

std::vector<RecordField<TraceRecord>> trace_fields(const study::StudyFeatures& features) {
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
      field<T>("torque", "N m", "$torque decided at this instant", &T::torque),
      field<T>("theta", "rad", "$rotor_angle", &T::theta),
      field<T>("omega", "rad/s", "$rotor velocity", &T::omega),
      field<T>("xp", "rad", "plastic extension", &T::xp),
      field<T>("xh", "rad", "hardening", &T::xh),
      field<T>("depth", "1", "reversal points on the stack", &T::depth),
      field<T>("mode", "1", "whether the hook sticks or slides", &T::mode, {}, mode_labels())};
  if (features.travel)
    fields.push_back(field<T>("reference", "count", "position that the control follows", &T::reference));
  if (features.phases) {
    fields.push_back(
        field<T>("phase", "1", "phase of the control at this instant", &T::phase, {}, phase_words()));
  }
  if (features.load) {
    fields.push_back(field<T>("load_theta", "rad", "$angle of the second mass", &T::load_theta));
    fields.push_back(field<T>("load_omega", "rad/s", "velocity of the second mass", &T::load_omega));
  }
  if (features.load_count)
    fields.push_back(field<T>("load_count", "count",
                              "reading of the encoder of the second mass, in its counts", &T::load_count));
  if (features.motor_count)
    fields.push_back(
        field<T>("motor_count", "count", "reading of the motor's encoder, in its counts", &T::motor_count));
  if (features.drive_torque) {
    fields.push_back(
        field<T>("drive_torque", "N m", "$torque of the motor at this instant", &T::drive_torque));
  }
  return fields;
}

}  // namespace zerocount::layout
