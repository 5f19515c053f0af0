#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/report/reported_study.hpp"

namespace zerocount {

/// The values of an axis, sorted, each once.
std::vector<double> values_of(const SweepAxis& axis);

/// Points that differ only in the axes `along`.
struct PointGroup {
  std::string label;                 ///< the values of the other axes; empty where there are none
  std::vector<std::int64_t> points;  ///< rising
};

/// All points in such groups, in the order of their first points.
std::vector<PointGroup> groups_along(const ReportedStudy& reported, const std::vector<std::size_t>& along);

/// Axes of the sweep that are numbers at every point and take at least `least` values while all others stay
/// as they are (which those that the cases of a study set do not): their indices, the one with the most
/// values first.
std::vector<std::size_t> numeric_axes(const ReportedStudy& reported, std::size_t least);

}  // namespace zerocount
