#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

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
};

/// "group_name", or "name" without a group: the field's name in flat formats.
template <class Subject>
std::string flat_name(const ReportField<Subject>& field) {
  return field.group.empty() ? field.name : field.group + "_" + field.name;
}

/// A count as the value of a field.
inline double to_double(std::int64_t count) {
  return static_cast<double>(count);
}

inline constexpr int one_line = -1;  ///< as the indent of JSON

/// A JSON object as text, ending with a line break. Bytes that are not UTF-8 are replaced.
inline std::string json_text(const nlohmann::ordered_json& json, int indent = 2) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// Adds the numbers of `subject` to a JSON object under the names of their fields, by group. Whole numbers
/// are written as integers, NaN as null.
template <class Subject>
void add_fields(nlohmann::ordered_json& json, const std::vector<ReportField<Subject>>& fields,
                const Subject& subject) {
  for (const ReportField<Subject>& field : fields) {
    nlohmann::ordered_json& place = field.group.empty() ? json : json[field.group];
    const double value = field.value(subject);
    if (field.whole && !std::isnan(value)) {
      place[field.name] = static_cast<std::int64_t>(value);
    } else {
      place[field.name] = value;
    }
  }
}

}  // namespace zerocount::text
