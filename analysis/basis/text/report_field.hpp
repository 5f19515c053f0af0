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
  /// JSON object that contains the field, such as "arrival_time"; empty at the top.
  std::string group;
  std::string name;                             ///< Name of the field within the group.
  std::string unit;                             ///< Unit; "1" if dimensionless.
  std::string long_name;                        ///< Meaning, with the denominator of a proportion or mean.
  bool whole{false};                            ///< True if the value is a whole number.
  std::function<double(const Subject&)> value;  ///< Value in `unit`; NaN if undefined.
  /// Error band to which the value belongs, counts. The group is nested in the group of the band.
  std::optional<std::int64_t> band{};
  /// Tolerance of the position error to which the value belongs, rad. The group is nested in the group of the
  /// tolerance.
  std::optional<double> tolerance{};
};

/// Largest error within the error band (counts) or tolerance (rad) of the field; nothing if the field has
/// neither.
template <class Subject>
std::optional<double> limit_of(const ReportField<Subject>& field) {
  return field.band ? static_cast<double>(*field.band) : field.tolerance;
}

/// Name of the field in flat formats: "group_name", or "name" without a group. For an error band it is
/// "band_group_name[1]", for a tolerance "tolerance_group_name[1e-08]". The name of a mass precedes it.
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

/// Converts a count to double, as the value of a field.
inline double to_double(std::int64_t count) {
  return static_cast<double>(count);
}

}  // namespace zerocount::text
