#include "analysis/identification/test_record.hpp"

#include <algorithm>
#include <cmath>

namespace zerocount::identification {

double torque_range(const TestRecord& record) {
  double low = 0.0;  // the torque before the first sample
  double high = 0.0;
  for (const motion::TorqueCourse& torque : record.torque) {
    low = std::min(low, torque.now);
    high = std::max(high, torque.now);
  }
  return high - low;
}

double largest_torque(const TestRecord& record) {
  double largest = 0.0;
  for (const motion::TorqueCourse& torque : record.torque) largest = std::max(largest, std::abs(torque.now));
  return largest;
}

}  // namespace zerocount::identification
