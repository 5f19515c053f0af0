#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace zerocount::text {

/// One reported number of a summary. Lists of fields are the single source of the names in the JSON and CSV
/// summaries and in the results file.
template <class Subject>
struct ReportField {
  std::string group;      ///< JSON object that holds it, such as "arrival_time"; empty at the top
  std::string name;       ///< within its group
  std::string unit;       ///< "1" where dimensionless
  std::string long_name;  ///< what it is, with the denominator of a proportion or mean
  bool whole{false};      ///< a whole number
  std::function<double(const Subject&)> value;  ///< in `unit`; NaN if undefined
  std::optional<std::int64_t> band{};  ///< error band that it is of, counts; its group is in that of the band
  std::optional<double> tolerance{};   ///< of the position error that it is of, rad; likewise
};

/// The largest error within the field's band, or tolerance; nothing of another field.
template <class Subject>
std::optional<double> limit_of(const ReportField<Subject>& field) {
  return field.band ? static_cast<double>(*field.band) : field.tolerance;
}

/// "group_name", or "name" without a group: the field's name in flat formats. That of an error band is
/// "band_group_name[1]", that of a tolerance "tolerance_group_name[1e-08]", with the name of a mass before
/// it.
template <class Subject>
std::string flat_name(const ReportField<Subject>& field) {
  const std::string name = field.group.empty() ? field.name : field.group + "_" + field.name;
  if (field.tolerance) {
    const bool of_mass = name.starts_with("load_") || name.starts_with("motor_");
    const std::size_t stem = of_mass ? name.find('_') + 1 : 0;
    return fmt::format("{}tolerance_{}[{}]", name.substr(0, stem), name.substr(stem), *field.tolerance);
  }
  return field.band ? "band_" + name + "[" + std::to_string(*field.band) + "]" : name;
}

/// A count as the value of a field.
inline double to_double(std::int64_t count) {
  return static_cast<double>(count);
}

}  // namespace zerocount::text
