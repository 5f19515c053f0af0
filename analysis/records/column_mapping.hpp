#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/text/unit.hpp"

namespace zerocount::records {

/// The quantities to which `--column` can assign a column.
enum class Quantity {
  time,
  torque,        ///< commanded, of a rotary axis
  drive_torque,  ///< of the motor at the sample
  angle,
  force,        ///< commanded, of a linear axis
  drive_force,  ///< of the motor at the sample
  position,
  repetition  ///< a new repetition of the test begins where the value changes
};

std::string_view name_of(Quantity quantity);
/// Names of all quantities, for messages.
std::string quantity_names();
/// The dimension of the quantity's values; none for the repetition.
std::optional<text::Dimension> dimension_of(Quantity quantity);
bool is_linear(Quantity quantity);  ///< of a linear axis only
/// The SI unit of the quantity's values; not of the repetition.
text::Unit si_unit(Quantity quantity);

/// The source of the values of a quantity: `torque=current[A]*0.87`.
///
///     QUANTITY=COLUMN  or  QUANTITY=COLUMN[UNIT]FACTORS,  FACTORS any number of *NUMBER and /NUMBER
///
/// The factors make the quantity from numbers in UNIT. With a UNIT of the quantity's own dimension they apply
/// beside its conversion to SI units (a gear ratio; most need none). A UNIT of another dimension needs them:
/// their product is the quantity in its SI unit for one UNIT, 0.87 N m/A here.
struct ColumnMapping {
  Quantity quantity{Quantity::time};
  std::string column;                ///< name in the header, #NUMBER from 1, or path of a dataset
  std::optional<text::Unit> unit{};  ///< none: that of the header, or the SI unit
  std::optional<double> factor{};    ///< product of the factors; none without any
};

/// The mapping, or the reason why the text is none.
struct ParsedMapping {
  ColumnMapping mapping;
  std::string fault{};  ///< empty if it is a mapping
};
ParsedMapping parse_mapping(std::string_view text);

}  // namespace zerocount::records
