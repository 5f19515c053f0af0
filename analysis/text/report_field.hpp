#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace zerocount::text {

/// One reported number of a summary. Lists of fields are the single source of the names in the JSON and CSV
/// summaries and in the results file.
template <class Subject>
struct ReportField {
  std::string group;      ///< JSON object that holds it, such as "settling_time"; empty at the top
  std::string name;       ///< within its group
  std::string unit;       ///< "1" where dimensionless
  std::string long_name;  ///< what it is, with the denominator of a proportion or mean
  bool whole{false};      ///< a whole number
  std::function<double(const Subject&)> value;  ///< in `unit`; NaN if undefined
  std::optional<std::int64_t> band{};  ///< error band that it is of, counts; its group is in that of the band
};

/// "group_name", or "name" without a group: the field's name in flat formats. That of an error band is
/// "band_group_name[1]".
template <class Subject>
std::string flat_name(const ReportField<Subject>& field) {
  const std::string name = field.group.empty() ? field.name : field.group + "_" + field.name;
  return field.band ? "band_" + name + "[" + std::to_string(*field.band) + "]" : name;
}

/// A count as the value of a field.
inline double to_double(std::int64_t count) {
  return static_cast<double>(count);
}

}  // namespace zerocount::text
