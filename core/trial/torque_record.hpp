#pragma once

#include <vector>

namespace zerocount::trial {

/// A recorded torque over time. Each value is held until the next time, the last one for ever.
struct TorqueRecord {
  std::vector<double> time;    ///< s, increasing, the first one 0
  std::vector<double> torque;  ///< [time], N m
};

/// The torque (N m) at `time` (s), at least 0. A time that is within 1e-6 of the record's next interval
/// before a row counts as the row's: k·T and a written time differ by rounding.
double torque_at(const TorqueRecord& record, double time);

}  // namespace zerocount::trial
