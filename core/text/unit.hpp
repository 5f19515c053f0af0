#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace zerocount::text {

/// Physical dimension of the numbers in a column of a measured record.
enum class Dimension {
  time,        ///< Time; SI unit s
  torque,      ///< Torque; SI unit N m
  angle,       ///< Angle; SI unit rad
  force,       ///< Force; SI unit N
  length,      ///< Length; SI unit m
  current,     ///< Electric current; SI unit A
  voltage,     ///< Voltage; SI unit V
  count,       ///< Steps of an encoder or of a converter; no SI unit
  proportion,  ///< Fraction of a rated value; dimensionless, no SI unit
};

/// A unit of the numbers in a column of a measured record.
struct Unit {
  std::string_view name;
  Dimension dimension;
  double si;  ///< Value of one unit in the SI unit of its dimension
};

/// The unit with this name; empty if there is none. Blanks, '·' and '*' inside the name are ignored: "N m",
/// "Nm" and "N·m" are the same. A count has many names, in any case: "inc", "Ticks", "LSB".
std::optional<Unit> unit_named(std::string_view name);

/// The names of all units, for messages.
std::string unit_names();

}  // namespace zerocount::text
