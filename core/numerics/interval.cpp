#include "core/numerics/interval.hpp"

#include <cmath>

#include <fmt/format.h>

namespace zerocount::numerics {

Interval all_numbers() {
  return {};
}

Interval above(double low) {
  return {.low = low};
}

Interval at_least(double low) {
  return {.low = low, .low_included = true};
}

Interval closed(double low, double high) {
  return {.low = low, .high = high, .low_included = true, .high_included = true};
}

Interval half_open(double low, double high) {
  return {.low = low, .high = high, .low_included = true};
}

bool contains(const Interval& interval, double value) {
  const bool above_low = value > interval.low || (interval.low_included && value == interval.low);
  const bool below_high = value < interval.high || (interval.high_included && value == interval.high);
  return above_low && below_high;
}

bool contains(const Interval& outer, const Interval& inner) {
  const bool low_fits =
      inner.low > outer.low || (inner.low == outer.low && (outer.low_included || !inner.low_included));
  const bool high_fits =
      inner.high < outer.high || (inner.high == outer.high && (outer.high_included || !inner.high_included));
  return low_fits && high_fits;
}

std::string notation(const Interval& interval) {
  return fmt::format("{}{}, {}{}", interval.low_included ? '[' : '(', interval.low, interval.high,
                     interval.high_included ? ']' : ')');
}

std::string range_text(const Interval& interval) {
  std::string words;
  if (std::isfinite(interval.low)) {
    words = fmt::format("{} {}", interval.low_included ? "at least" : "greater than", interval.low);
  }
  if (std::isfinite(interval.high)) {
    if (!words.empty()) words += " and ";
    words += fmt::format("{} {}", interval.high_included ? "at most" : "less than", interval.high);
  }
  return words.empty() ? "any finite number" : words;
}

}  // namespace zerocount::numerics
