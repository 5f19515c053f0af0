#pragma once

#include <span>
#include <string>
#include <string_view>

namespace zerocount::report {

// The quantities of analysis/text, in which a line does not break between a number and its unit.
std::string quantity_text(double value, std::string_view unit);
std::string range_text(double low, double high, std::string_view unit);
std::string list_text(std::span<const double> values, std::string_view unit);

}  // namespace zerocount::report
