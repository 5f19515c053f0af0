#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <vector>

namespace zerocount::statistics {

/// Makes `known` the values that are not NaN, in their order.
inline void find_known(std::span<const double> values, std::vector<double>& known) {
  known.clear();
  std::ranges::copy_if(values, std::back_inserter(known), [](double value) { return !std::isnan(value); });
}

}  // namespace zerocount::statistics
