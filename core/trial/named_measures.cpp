#include "core/trial/named_measures.hpp"

namespace zerocount::trial {

std::span<const NamedMeasure> named_measures() {
  static constexpr NamedMeasure measures[]{{"arrived"},
                                           {"stable"},
                                           {"broke_away"},
                                           {"saturated"},
                                           {"arrival"},
                                           {"settling_time"},
                                           {"final_settling_time"},
                                           {"zero_fraction"},
                                           {"oscillation_amplitude"},
                                           {"oscillation_period"},
                                           {"overshoot"},
                                           {"travel_time"},
                                           {"midway_error"},
                                           {"final_error"},
                                           {"phase_changes"},
                                           {"encoder_disagreement"},
                                           {"true_error"},
                                           {"final_position"},
                                           {"holding_torque"},
                                           {"peak_torque"},
                                           {"creep"},
                                           {"reversal_depth"},
                                           {"jerk_count"},
                                           {"jerk_agreement"},
                                           {"true_overshoot", false, true},
                                           {"rest_error_rms", true},
                                           {"rest_error_range", true},
                                           {"rest_motion_rms", true},
                                           {"rest_motion_range", true},
                                           {"rest_torque_power", true},
                                           {"rest_torque_noise", true},
                                           {"following_error_rms", true},
                                           {"following_error_peak", true},
                                           {"reversal_spike", true},
                                           {"step_motion", true},
                                           {"step_made", true}};
  return measures;
}

std::span<const std::string_view> named_band_measures() {
  static constexpr std::string_view measures[]{"band_entry_time", "band_settling_time", "band_exits"};
  return measures;
}

}  // namespace zerocount::trial
