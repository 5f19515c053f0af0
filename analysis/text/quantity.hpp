#pragma once

#include <span>
#include <string>
#include <string_view>

/// Numbers with their units, as people write them.
namespace zerocount::text {

/// A number with so many significant digits and a short exponent: "5.9e6", "0.0125"; "–" for NaN.
std::string number_text(double value, int digits = 4);

/// A number with its unit; lengths, angles, times and frequencies with a prefix: "10 nm", "1.2 mm/s",
/// "16 kHz", "5.9e6 N/m". No unit where it is "1".
std::string quantity_text(double value, std::string_view unit, int digits = 4);

/// A range with its unit, with one prefix for both ends: "310 … 930 N s/m"; one number where they are equal.
std::string range_text(double low, double high, std::string_view unit);

/// Numbers with one unit: "20, 21, 20, 0 µm".
std::string list_text(std::span<const double> values, std::string_view unit);

}  // namespace zerocount::text
