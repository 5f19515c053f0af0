#pragma once

#include <vector>

#include "results/hdf5/hdf5.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::layout {

/// Writes a table of statistics to its group, for `points` design points.
/// @throws std::invalid_argument where a column has not one value per design point and index.
void write_statistic_table(hdf5::File& file, const StatisticTable& table, std::int64_t points);

/// The tables of statistics that a file has, in the order of statistic_groups().
/// @throws Failure (bad_data) where one is damaged.
std::vector<StatisticTable> read_statistic_tables(const hdf5::File& file);

}  // namespace zerocount::layout
