#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace zerocount::text {

/// Physical dimension of the numbers of a column.
enum class Dimension {
  time,        ///< SI unit: s
  torque,      ///< N m
  angle,       ///< rad
  force,       ///< N
  length,      ///< m
  current,     ///< A
  voltage,     ///< V
  count,       ///< Steps of an encoder or of a converter; no SI unit
  proportion,  ///< Fraction of a rated value; no SI unit
};

/// A unit of the columns of a record.
struct Unit {
  std::string_view name;
  Dimension dimension;
  double si;  ///< Value of one unit in the SI unit of its dimension
};

/// The unit of that name, or none. Blanks, '·' and '*' inside are ignored: "N m", "Nm" and "N·m" are the
/// same. A count has many names, in any case: "inc", "Ticks", "LSB".
std::optional<Unit> unit_named(std::string_view name);

/// The names of all units, for messages.
std::string unit_names();

}  // namespace zerocount::text
