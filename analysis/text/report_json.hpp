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

/// The object of an error band in the list "bands" of `json`.
inline nlohmann::ordered_json& object_of_band(nlohmann::ordered_json& json, std::int64_t band) {
  nlohmann::ordered_json& bands = json["bands"];
  for (nlohmann::ordered_json& object : bands) {
    if (object["band"] == band) return object;
  }
  bands.push_back({{"band", band}});
  return bands.back();
}

/// Adds the numbers of `subject` to a JSON object under the names of their fields, by band and group. Whole
/// numbers are written as integers, NaN as null.
template <class Subject>
void add_fields(nlohmann::ordered_json& json, const std::vector<ReportField<Subject>>& fields,
                const Subject& subject) {
  for (const ReportField<Subject>& field : fields) {
    nlohmann::ordered_json& object = field.band ? object_of_band(json, *field.band) : json;
    nlohmann::ordered_json& place = field.group.empty() ? object : object[field.group];
    const double value = field.value(subject);
    if (field.whole && !std::isnan(value)) {
      place[field.name] = static_cast<std::int64_t>(value);
    } else {
      place[field.name] = value;
    }
  }
}

}  // namespace zerocount::text
