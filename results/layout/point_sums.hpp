#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "results/hdf5/hdf5.hpp"

namespace zerocount::layout {

/// Sums over the trials of one design point, as plain numbers, from which its statistics are computed. Only
/// the accumulator that made the sums knows the meaning and order of the numbers.
struct PointSums {
  std::vector<std::int64_t> whole;
  std::vector<double> real;
};

/// The sums of several design points, as the columns of the tables /sums.
struct SumColumns {
  explicit SumColumns(std::span<const PointSums> sums);

  std::vector<std::int64_t> whole_counts, real_counts;  ///< Number of whole and of real numbers that belong
                                                        /// < to each design point, [point]
  std::vector<std::int64_t> whole;  ///< Whole numbers of all design points, one point after the other
  std::vector<double> real;
};

/// Writes the tables /sums for the design points from `first_point` on.
/// @param sums [point].
void write_sums(hdf5::File& file, std::int64_t first_point, std::span<const PointSums> sums);

/// Text that identifies the meaning and order of the numbers in /sums. It differs between programs that do
/// not understand each other's sums.
std::string sums_form();

}  // namespace zerocount::layout
