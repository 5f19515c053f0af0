#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "analysis/text/report_field.hpp"

namespace zerocount::text {

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
