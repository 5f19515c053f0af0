#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace zerocount::text {

// Numbers are read and written with std::from_chars and fmt, which know no locale. The functions of the C
// library (strtod, printf …) and streams take the decimal separator of the process, which an application that
// loads the extension of the Python package may have set to a comma.

/// The number that is the whole text, in the form of C; nothing if it is none or does not fit.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return number;
}

/// `value`, rounded to so many significant decimal digits: the double nearest to 2e-05, not
/// 1.9999999999999998e-05.
double round_to_digits(double value, int digits);

}  // namespace zerocount::text
