#pragma once

#include <span>
#include <string>
#include <string_view>

/// What the first screen of a page shows: the axis, what is assumed of it, its requirements and its values.
namespace zerocount::report {

/// A number with four significant digits and a short exponent: "5.9e6", "0.0125".
std::string number_text(double value);

/// A number with its unit; lengths, angles, times and frequencies with a prefix: "10 nm", "1.2 mm/s",
/// "16 kHz", "5.9e6 N/m". No unit where it is "1".
std::string quantity_text(double value, std::string_view unit);

/// A range with its unit, with one prefix for both ends: "310 … 930 N s/m"; one number where they are equal.
std::string range_text(double low, double high, std::string_view unit);

/// Numbers with one unit: "20, 21, 20, 0 µm".
std::string list_text(std::span<const double> values, std::string_view unit);

}  // namespace zerocount::report
