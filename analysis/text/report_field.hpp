#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace zerocount {

/// One reported number of a summary. Lists of fields are the single source of the names in the JSON and CSV
/// summaries and in the results file.
template <class Subject>
struct ReportField {
  std::string_view group;           ///< JSON object that holds it, such as "settling_time"; empty at the top
  std::string_view name;            ///< within its group
  std::string_view unit;            ///< "1" where dimensionless
  std::string_view long_name;       ///< what it is, with the denominator of a proportion or mean
  bool whole{false};                ///< a whole number
  double (*value)(const Subject&);  ///< in `unit`; NaN if undefined
};

/// "group_name", or "name" without a group: the field's name in flat formats.
template <class Subject>
std::string flat_name(const ReportField<Subject>& field) {
  if (field.group.empty()) return std::string(field.name);
  return std::string(field.group) + "_" + std::string(field.name);
}

/// A count as the value of a field.
inline double to_double(std::int64_t count) {
  return static_cast<double>(count);
}

}  // namespace zerocount
