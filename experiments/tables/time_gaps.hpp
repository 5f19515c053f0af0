#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace zerocount::tables {

/// A step of time that is much longer than those about it, as where rows of a record were lost.
struct TimeGap {
  std::size_t row;  ///< after the gap
  double step;      ///< s
  double usual;     ///< 90 % of the steps about it are not longer, s
};

/// The gaps of a record.
///
/// A step is a gap if it is more than four times as long as 90 % of the 20 steps before it and the 20 after
/// it (at least ten), and if at most 3 % of all steps, or three, are as long as half of it. So a record may
/// have uneven steps, several rates one after the other, or rows in bursts.
/// @param times increasing, s
std::vector<TimeGap> time_gaps(std::span<const double> times);

}  // namespace zerocount::tables
