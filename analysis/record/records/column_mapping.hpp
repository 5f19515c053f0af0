#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/text/unit.hpp"

namespace zerocount::records {

/// The quantities to which the command-line option `--column` can assign a column of a measured file.
enum class Quantity {
  time,
  torque,        ///< Commanded torque of a rotary axis.
  drive_torque,  ///< Motor torque at the instant of the sample, rotary axis.
  angle,
  force,        ///< Commanded force of a linear axis.
  drive_force,  ///< Motor force at the instant of the sample, linear axis.
  position,
  /// Number of the repetition of the test: when the value changes, a new repetition begins.
  repetition
};

std::string_view name_of(Quantity quantity);
/// Names of all quantities, for messages.
std::string quantity_names();
/// Dimension of the quantity's values; nothing for the repetition.
std::optional<text::Dimension> dimension_of(Quantity quantity);
bool is_linear(Quantity quantity);  ///< True if only linear axes have the quantity.
/// SI unit of the quantity's values. Must not be called for the repetition.
text::Unit si_unit(Quantity quantity);

/// The user's statement which column of a file holds a quantity, and in which unit: `torque=current[A]*0.87`.
///
///     QUANTITY=COLUMN  or  QUANTITY=COLUMN[UNIT]FACTORS,  FACTORS any number of *NUMBER and /NUMBER
///
/// The factors make the quantity from numbers in UNIT. With a UNIT of the quantity's own dimension they apply
/// beside its conversion to SI units (as a gear ratio does; most columns need none). A UNIT of another
/// dimension needs them: their product is the quantity in its SI unit for one UNIT, 0.87 N m/A here.
struct ColumnMapping {
  Quantity quantity{Quantity::time};
  std::string column;                ///< Column: name in the header, #NUMBER from 1, or path of a dataset.
  std::optional<text::Unit> unit{};  ///< Unit; nothing: the unit in the header, or the SI unit.
  std::optional<double> factor{};    ///< Product of the factors; nothing if there are none.
};

/// The column mapping that a text states, or the reason why the text is not a mapping.
struct ParsedMapping {
  ColumnMapping mapping;
  std::string fault{};  ///< Reason why the text is not a mapping; empty if it is one.
};
ParsedMapping parse_mapping(std::string_view text);

}  // namespace zerocount::records
