#include "analysis/record/records/equal_series.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace zerocount::records {
namespace {

constexpr double rounding = 1e-9;

/// Whether two sequences agree as far as the shorter one goes: differences from the first element, times the
/// unit, are equal within 10⁻⁹ of the largest.
bool begin_equal(std::span<const double> one, double unit, std::span<const double> other, double other_unit) {
  const std::size_t count = std::min(one.size(), other.size());
  double largest = 0.0;
  double farthest = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double value = unit * (one[k] - one[0]);
    largest = std::max(largest, std::abs(value));
    farthest = std::max(farthest, std::abs(value - other_unit * (other[k] - other[0])));
  }
  return farthest <= rounding * largest;
}

double unit_of_angle(const RawSeries& series) {
  return series.count_size > 0.0 ? series.count_size : 1.0;
}

}  // namespace

bool are_equal(const RawSeries& one, const RawSeries& other) {
  if (one.time.empty() || other.time.empty() || one.linear != other.linear) return false;
  return begin_equal(one.angle, unit_of_angle(one), other.angle, unit_of_angle(other)) &&
         begin_equal(one.torque, 1.0, other.torque, 1.0) && begin_equal(one.time, 1.0, other.time, 1.0);
}

}  // namespace zerocount::records
