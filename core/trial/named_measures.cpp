#include "core/trial/named_measures.hpp"

#include <array>

namespace zerocount::trial {
namespace {

template <auto Member>
double value_of(const MoveOutcome& move) {
  return static_cast<double>(move.*Member);
}

}  // namespace

std::span<const NamedMeasure> named_measures() {
  using M = MoveOutcome;
  static constexpr std::array measures{
      NamedMeasure{"arrived", value_of<&M::arrived>},
      NamedMeasure{"stable", value_of<&M::stable>},
      NamedMeasure{"broke_away", value_of<&M::broke_away>},
      NamedMeasure{"saturated", value_of<&M::saturated>},
      NamedMeasure{"arrival", value_of<&M::arrival>},
      NamedMeasure{"settling_time", value_of<&M::settling_time>},
      NamedMeasure{"final_settling_time", value_of<&M::final_settling_time>},
      NamedMeasure{"zero_fraction", value_of<&M::zero_fraction>},
      NamedMeasure{"oscillation_amplitude", value_of<&M::oscillation_amplitude>},
      NamedMeasure{"oscillation_period", value_of<&M::oscillation_period>},
      NamedMeasure{"overshoot", value_of<&M::overshoot>},
      NamedMeasure{"travel_time", value_of<&M::travel_time>},
      NamedMeasure{"midway_error", value_of<&M::midway_error>},
      NamedMeasure{"final_error", value_of<&M::final_error>},
      NamedMeasure{"phase_changes", value_of<&M::phase_changes>},
      NamedMeasure{"encoder_disagreement", value_of<&M::encoder_disagreement>},
      NamedMeasure{"true_error", value_of<&M::true_error>},
      NamedMeasure{"final_position", value_of<&M::final_position>},
      NamedMeasure{"holding_torque", value_of<&M::holding_torque>},
      NamedMeasure{"peak_torque", value_of<&M::peak_torque>},
      NamedMeasure{"creep", value_of<&M::creep>},
      NamedMeasure{"reversal_depth", value_of<&M::reversal_depth>},
      NamedMeasure{"jerk_count", value_of<&M::jerk_count>},
      NamedMeasure{"jerk_agreement", value_of<&M::jerk_agreement>},
      NamedMeasure{"true_overshoot", value_of<&M::true_overshoot>, false, true},
      NamedMeasure{"rest_error_rms", value_of<&M::rest_error_rms>, true},
      NamedMeasure{"rest_error_range", value_of<&M::rest_error_range>, true},
      NamedMeasure{"rest_motion_rms", value_of<&M::rest_motion_rms>, true},
      NamedMeasure{"rest_motion_range", value_of<&M::rest_motion_range>, true},
      NamedMeasure{"rest_torque_power", value_of<&M::rest_torque_power>, true},
      NamedMeasure{"rest_torque_noise", value_of<&M::rest_torque_noise>, true},
      NamedMeasure{"following_error_rms", value_of<&M::following_error_rms>, true},
      NamedMeasure{"following_error_peak", value_of<&M::following_error_peak>, true},
      NamedMeasure{"reversal_spike", value_of<&M::reversal_spike>, true},
      NamedMeasure{"step_motion", value_of<&M::step_motion>, true},
      NamedMeasure{"step_made", value_of<&M::step_made>, true}};
  return measures;
}

std::span<const NamedBandMeasure> named_band_measures() {
  static constexpr std::array<NamedBandMeasure, 3> measures{
      {{"band_entry_time", &BandOutcome::entry_time},
       {"band_settling_time", &BandOutcome::settling_time},
       {"band_exits", &BandOutcome::exits}}};
  return measures;
}

}  // namespace zerocount::trial
