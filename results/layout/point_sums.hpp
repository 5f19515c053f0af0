#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace zerocount::layout {

/// The sums over the trials of one design point, from which its statistics follow, as plain numbers: what
/// they mean is known to the accumulator that made them.
struct PointSums {
  std::vector<std::int64_t> whole;
  std::vector<double> real;
};

/// Stands for what the numbers are, and in which order: it differs between programs that do not understand
/// each other's sums.
std::string sums_form();

}  // namespace zerocount::layout
