#include "core/trial/torque_record.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace zerocount::trial {

double record_duration(const TorqueRecord& record) {
  const std::vector<double>& times = record.time;
  return times.size() < 2 ? 0.0 : 2.0 * times.back() - times[times.size() - 2];
}

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

TorqueRamp make_torque_ramp(double from, double to, double rate, double sample_rate) {
  // A ramp of a whole number of samples must not gain one by rounding.
  constexpr double whole = 1e-9;
  const double samples = std::abs(to - from) / rate * sample_rate;
  return {from, to, std::copysign(rate / sample_rate, to - from),
          static_cast<std::int64_t>(std::ceil(samples - whole * std::fmax(samples, 1.0)))};
}

double torque_at(const TorqueRamp& ramp, std::int64_t i) {
  return i < ramp.samples ? ramp.from + static_cast<double>(i) * ramp.per_sample : ramp.to;
}

}  // namespace zerocount::trial
