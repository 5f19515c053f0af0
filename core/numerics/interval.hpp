#pragma once

#include <limits>
#include <string>

namespace zerocount::numerics {

/// A set of real numbers between two ends: the range that a parameter allows, or the support of a
/// distribution. An infinite end is never included.
struct Interval {
  double low{-std::numeric_limits<double>::infinity()};
  double high{std::numeric_limits<double>::infinity()};
  bool low_included{false};
  bool high_included{false};
};

Interval all_numbers();
Interval above(double low);                   ///< The open interval (low, ∞): numbers greater than `low`
Interval at_least(double low);                ///< The interval [low, ∞): `low` and greater numbers
Interval closed(double low, double high);     ///< The closed interval [low, high], which includes both ends
Interval half_open(double low, double high);  ///< The half-open interval [low, high), which includes `low`
                                              ///< but not `high`

bool contains(const Interval& interval, double value);

/// Whether every number of `inner` is in `outer`.
bool contains(const Interval& outer, const Interval& inner);

/// The interval in mathematical notation: "(0, 1]", "[1, inf)".
std::string notation(const Interval& interval);

/// The interval in words, for messages: "greater than 0 and at most 1", or "any finite number" if neither end
/// is finite.
std::string range_text(const Interval& interval);

}  // namespace zerocount::numerics
