#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "results/hdf5/hdf5.hpp"

namespace zerocount::layout {

/// The sums over the trials of one design point, from which its statistics follow, as plain numbers. Only the
/// accumulator that made them knows their meaning.
struct PointSums {
  std::vector<std::int64_t> whole;
  std::vector<double> real;
};

/// The sums of several points, as the columns of /sums.
struct SumColumns {
  explicit SumColumns(std::span<const PointSums> sums);

  std::vector<std::int64_t> whole_counts, real_counts;  ///< Count of whole and of real numbers of each point
  std::vector<std::int64_t> whole;  ///< Whole numbers of all points, one point after the other
  std::vector<double> real;
};

/// Writes /sums for the points from `first_point` on. @param sums [point].
void write_sums(hdf5::File& file, std::int64_t first_point, std::span<const PointSums> sums);

/// Identifies the meaning and order of the numbers. It differs between programs that do not understand each
/// other's sums.
std::string sums_form();

}  // namespace zerocount::layout
