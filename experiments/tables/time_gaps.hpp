#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace zerocount::tables {

/// A step between the times of two rows of a record that is much longer than the steps around it. Rows of the
/// record were probably lost there.
struct TimeGap {
  std::size_t row;  ///< index of the row after the gap
  double step;      ///< duration of the gap, s
  double usual;     ///< usual step around the gap, s: 90 % of the neighbouring steps are not longer
};

/// The gaps in the times of a record: steps that are much longer than those around them.
///
/// A step is a gap if it is more than four times as long as 90 % of the 20 steps before it and the 20 after
/// it (at least ten), and if at most 3 % of all steps, or three, are as long as half of it. So a record may
/// have uneven steps, several rates one after the other, or rows in bursts.
/// @param times increasing times of the rows, s
std::vector<TimeGap> time_gaps(std::span<const double> times);

}  // namespace zerocount::tables
