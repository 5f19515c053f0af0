#include "core/trial/torque_record.hpp"

#include <algorithm>
#include <cstddef>

namespace zerocount::trial {

double torque_at(const TorqueRecord& record, double time) {
  constexpr double rounding = 1e-6;  // of an interval
  const auto after = std::upper_bound(record.time.begin(), record.time.end(), time);
  auto row = static_cast<std::size_t>(after - record.time.begin()) - 1;
  if (row + 1 < record.time.size()) {
    const double interval = record.time[row + 1] - record.time[row];
    if (record.time[row + 1] - time <= rounding * interval) ++row;
  }
  return record.torque[row];
}

}  // namespace zerocount::trial
