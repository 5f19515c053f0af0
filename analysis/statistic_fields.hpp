#pragma once

#include <span>
#include <string>
#include <string_view>

#include "analysis/point_statistics.hpp"

namespace zerocount {

/// One number of PointSummary as it is reported. The list of them is the one source of the names in the
/// JSON and CSV summary and in the results file.
struct StatisticField {
  std::string_view group;      ///< JSON object that holds it, such as "settling_time"; empty at the top
  std::string_view name;       ///< within its group
  std::string_view unit;       ///< "1" where dimensionless
  std::string_view long_name;  ///< what it is, with the denominator of a share or mean
  bool whole{false};           ///< a whole number
  double (*value)(const PointSummary&);  ///< in `unit`; NaN where not defined
};

/// All of them, in the order of the report.
std::span<const StatisticField> statistic_fields();

/// "group_name", or "name" at the top: the field's name where there are no groups.
std::string flat_name(const StatisticField& field);

}  // namespace zerocount
