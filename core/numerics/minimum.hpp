#pragma once

#include <functional>
#include <utility>

namespace zerocount::numerics {

/// A minimum of f between `low` and `high`, (x, f(x)), by Brent's method; of several one of them.
/// @param bits of x; the method stops at 2^-bits of |x|, and at about that absolutely
std::pair<double, double> minimum_between(double low, double high, int bits,
                                          const std::function<double(double)>& f);

}  // namespace zerocount::numerics
