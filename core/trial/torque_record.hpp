#pragma once

#include <cstdint>
#include <vector>

namespace zerocount::trial {

/// A recorded torque over time. Each value is held until the next time, the last one for ever.
struct TorqueRecord {
  std::vector<double> time;    ///< Times from which each value holds, s, increasing, the first one 0
  std::vector<double> torque;  ///< Torque that holds from each of the times on, N m
};

/// Duration of a recorded torque (s). Its last row lasts as long as the row before it; 0 for fewer than two
/// rows.
double record_duration(const TorqueRecord& record);

/// The recorded torque (N m) at the time `time` (s), at least 0. A time that is before a row's time by at
/// most 1e-6 of the record's next interval counts as the row's time, because k·T and a written time differ by
/// rounding.
double torque_at(const TorqueRecord& record, double time);

/// A torque that goes from one level to the next at a constant rate, sampled: each value is held until the
/// next instant.
struct TorqueRamp {
  double from{0.0};        ///< Torque at the start, N m
  double to{0.0};          ///< Torque at the end, N m
  double per_sample{0.0};  ///< Change of the torque from sample to sample, with its sign, N m
  /// Number of samples on the way: the number of the first sample that has the torque `to`. With s = |to −
  /// from|/rate·sample_rate it is ⌈s − 1e-9·max(s, 1)⌉: a whole number s must not gain a sample by rounding.
  std::int64_t samples{0};
};

/// Creates the ramp between two torques (N m).
/// @param rate absolute value of the rate, N m/s, positive.
/// @param sample_rate Hz.
TorqueRamp make_torque_ramp(double from, double to, double rate, double sample_rate);

/// The torque (N m) at sample i = 0, 1, … of the ramp: from + i·per_sample, then `to`.
double torque_at(const TorqueRamp& ramp, std::int64_t i);

}  // namespace zerocount::trial
