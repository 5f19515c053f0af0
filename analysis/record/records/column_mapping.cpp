#include "analysis/record/records/column_mapping.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "core/text/text.hpp"

namespace zerocount::records {
namespace {

struct QuantityRow {
  std::string_view name;
  std::optional<text::Dimension> dimension;
};

/// Names and dimensions of the quantities, in the order of Quantity.
constexpr std::array<QuantityRow, 8> quantity_rows{{{"time", text::Dimension::time},
                                                    {"torque", text::Dimension::torque},
                                                    {"drive_torque", text::Dimension::torque},
                                                    {"angle", text::Dimension::angle},
                                                    {"force", text::Dimension::force},
                                                    {"drive_force", text::Dimension::force},
                                                    {"position", text::Dimension::length},
                                                    {"repetition", std::nullopt}}};

/// The product of factors written as "*NUMBER" and "/NUMBER", one after the other; nothing if the text has
/// anything else.
std::optional<double> product_of(std::string_view text) {
  double product = 1.0;
  while (!text.empty()) {
    const char sign = text.front();
    if (sign != '*' && sign != '/') return std::nullopt;
    text = text::trimmed(text.substr(1));
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || !std::isfinite(number) || number == 0.0) return std::nullopt;
    product = sign == '*' ? product * number : product / number;
    text = text::trimmed(text.substr(static_cast<std::size_t>(end - text.data())));
  }
  return std::isfinite(product) && product != 0.0 ? std::optional(product) : std::nullopt;
}

}  // namespace

std::string_view name_of(Quantity quantity) {
  return quantity_rows[static_cast<std::size_t>(quantity)].name;
}

std::string quantity_names() {
  std::string text;
  for (const QuantityRow& row : quantity_rows) text += (text.empty() ? "" : ", ") + std::string(row.name);
  return text;
}

std::optional<text::Dimension> dimension_of(Quantity quantity) {
  return quantity_rows[static_cast<std::size_t>(quantity)].dimension;
}

text::Unit si_unit(Quantity quantity) {
  switch (dimension_of(quantity).value()) {
    case text::Dimension::time:
      return text::unit_named("s").value();
    case text::Dimension::torque:
      return text::unit_named("N m").value();
    case text::Dimension::angle:
      return text::unit_named("rad").value();
    case text::Dimension::force:
      return text::unit_named("N").value();
    case text::Dimension::length:
      return text::unit_named("m").value();
    case text::Dimension::current:
    case text::Dimension::voltage:
    case text::Dimension::count:
    case text::Dimension::proportion:
      break;
  }
  throw std::invalid_argument("a quantity without an SI unit");
}

bool is_linear(Quantity quantity) {
  return dimension_of(quantity) == text::Dimension::force ||
         dimension_of(quantity) == text::Dimension::length;
}

ParsedMapping parse_mapping(std::string_view text) {
  ParsedMapping parsed;
  const auto refuse = [&](std::string fault) {
    parsed.fault = fmt::format("'{}': {}", text::printable(text), fault);
    return parsed;
  };
  const std::size_t equals = text.find('=');
  const std::string_view name = text::trimmed(text.substr(0, equals));
  const auto row = std::find_if(quantity_rows.begin(), quantity_rows.end(),
                                [&](const QuantityRow& known) { return known.name == name; });
  if (equals == std::string_view::npos || row == quantity_rows.end()) {
    return refuse(fmt::format("expected QUANTITY=COLUMN, with QUANTITY one of {}", quantity_names()));
  }
  parsed.mapping.quantity = static_cast<Quantity>(row - quantity_rows.begin());
  std::string_view column = text::trimmed(text.substr(equals + 1));
  const std::size_t close = column.rfind(']');
  const std::size_t open = close == std::string_view::npos ? close : column.rfind('[', close);
  if (open != std::string_view::npos) {
    const std::string_view unit = column.substr(open + 1, close - open - 1);
    const std::string_view factors = text::trimmed(column.substr(close + 1));
    column = text::trimmed(column.substr(0, open));
    parsed.mapping.unit = text::unit_named(unit);
    if (!parsed.mapping.unit) {
      return refuse(fmt::format("'{}' is not a known unit; expected one of {}", text::printable(unit),
                                text::unit_names()));
    }
    if (!factors.empty()) parsed.mapping.factor = product_of(factors);
    if (!factors.empty() && !parsed.mapping.factor) {
      return refuse(fmt::format("'{}' after the unit; expected factors *NUMBER or /NUMBER other than 0",
                                text::printable(factors)));
    }
    if (!row->dimension) return refuse(fmt::format("a {} has no unit", name));
  }
  if (column.empty()) return refuse("the column is missing after '='");
  parsed.mapping.column = column;
  return parsed;
}

}  // namespace zerocount::records
