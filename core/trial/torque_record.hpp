#pragma once

#include <cstdint>
#include <vector>

namespace zerocount::trial {

/// A recorded torque over time. Each value is held until the next time, the last one for ever.
struct TorqueRecord {
  std::vector<double> time;    ///< Times, s, increasing, the first one 0
  std::vector<double> torque;  ///< Torque from each time on, N m
};

/// Duration of the record (s). Its last row lasts as long as the row before it.
double record_duration(const TorqueRecord& record);

/// The torque (N m) at `time` (s), at least 0. A time that is within 1e-6 of the record's next interval
/// before a row counts as the row's: k·T and a written time differ by rounding.
double torque_at(const TorqueRecord& record, double time);

/// A torque that goes from one level to the next at a constant rate, sampled: each value is held until the
/// next instant.
struct TorqueRamp {
  double from{0.0};        ///< N m
  double to{0.0};          ///< N m
  double per_sample{0.0};  ///< Change from sample to sample, with its sign, N m
  /// Number of samples on the way: the first sample that has the torque `to`. With s = |to −
  /// from|/rate·sample_rate it is ⌈s − 1e-9·max(s, 1)⌉: a whole number s must not gain a sample by rounding.
  std::int64_t samples{0};
};

/// The ramp between two torques (N m).
/// @param rate magnitude of the rate, N m/s, positive. @param sample_rate Hz.
TorqueRamp make_torque_ramp(double from, double to, double rate, double sample_rate);

/// The torque (N m) at sample i = 0, 1, … of the ramp: from + i·per_sample, then `to`.
double torque_at(const TorqueRamp& ramp, std::int64_t i);

}  // namespace zerocount::trial
