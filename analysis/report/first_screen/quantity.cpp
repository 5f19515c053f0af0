#include "analysis/report/first_screen/quantity.hpp"

#include "analysis/text/quantity.hpp"

namespace zerocount::report {
namespace {

/// Without places for a line break.
std::string unbroken(std::string text) {
  constexpr std::string_view no_break_space = "\u00a0";
  for (std::size_t at = text.find(' '); at != std::string::npos; at = text.find(' ', at + 1))
    text.replace(at, 1, no_break_space);
  return text;
}

}  // namespace

std::string quantity_text(double value, std::string_view unit) {
  return unbroken(text::quantity_text(value, unit));
}

std::string range_text(double low, double high, std::string_view unit) {
  return unbroken(text::range_text(low, high, unit));
}

std::string list_text(std::span<const double> values, std::string_view unit) {
  return unbroken(text::list_text(values, unit));
}

}  // namespace zerocount::report
