#pragma once

#include <string>

/// Proportions as percentages. No bound is ever rounded towards what it does not show: a lower bound is
/// rounded down, an upper bound up.
namespace zerocount::text {

/// A proportion that was given, as a percentage with as many digits as it takes to tell it from 0 and 1:
/// "95 %", "99.99999 %".
std::string percent(double proportion);

/// A proportion that was observed, rounded to as many digits as tell it from 0 and 1, at least one decimal:
/// "97.4 %", "99.96 %"; "0 %" and "100 %" are exact.
std::string percent_near(double proportion);

/// A lower bound, rounded down to two significant digits of the smaller of p and 1 − p, and to one decimal if
/// both are above 1 %. Never "100 %": no sample shows that.
std::string percent_at_least(double proportion);

/// An upper bound, rounded up to two significant digits, and to one decimal above 1 %. Never "0 %" unless it
/// is 0.
std::string percent_at_most(double proportion);

/// A number rounded down or up to so many decimals; what rounding errors add is not rounded.
std::string rounded_down(double value, int decimals);
std::string rounded_up(double value, int decimals);

/// "96.6, 99.1": two bounds of a proportion in percent, rounded outward.
std::string percent_bounds(double low, double high, int decimals = 1, const char* between = ", ");

}  // namespace zerocount::text
