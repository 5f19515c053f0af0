#pragma once

#include <string>
#include <string_view>

namespace zerocount::text {

/// True if a spreadsheet would take a cell of this text for a formula or a command: it begins with = or @, or
/// with a sign before something other than a number with a unit.
bool is_formula(std::string_view text);

/// A field of CSV (RFC 4180): quoted where it holds a comma, a quote or a line break. A formula gets an
/// apostrophe before it, so that a spreadsheet shows it as text.
std::string csv_field(std::string_view text);

}  // namespace zerocount::text
