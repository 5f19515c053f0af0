#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "analysis/text/report_field.hpp"

namespace zerocount {

/// Adds the numbers of `subject` to a JSON object under the names of their fields, by group. Whole numbers
/// are written as integers, NaN as null.
template <class Subject>
void add_fields(nlohmann::ordered_json& json, std::span<const ReportField<Subject>> fields,
                const Subject& subject) {
  for (const ReportField<Subject>& field : fields) {
    nlohmann::ordered_json& place = field.group.empty() ? json : json[std::string(field.group)];
    const double value = field.value(subject);
    if (field.whole && !std::isnan(value)) {
      place[std::string(field.name)] = static_cast<std::int64_t>(value);
    } else {
      place[std::string(field.name)] = value;
    }
  }
}

}  // namespace zerocount
