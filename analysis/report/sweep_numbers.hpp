#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/report/reported_study.hpp"

namespace zerocount::report {

/// The distinct values of an axis, sorted.
std::vector<double> values_of(const study::SweepAxis& axis);

/// Points that differ only in the axes `along`.
struct PointGroup {
  std::string label;                 ///< the values of the other axes; empty without other axes
  std::vector<std::int64_t> points;  ///< increasing
};

/// All points divided into such groups, in the order of their first points.
std::vector<PointGroup> groups_along(const ReportedStudy& reported, const std::vector<std::size_t>& along);

/// Indices of the sweep's axes that are numbers at every point and have at least `min_values` values
/// while all others are constant (this excludes keys set by cases). The axis with the most values comes
/// first.
std::vector<std::size_t> numeric_axes(const ReportedStudy& reported, std::size_t min_values);

}  // namespace zerocount::report
