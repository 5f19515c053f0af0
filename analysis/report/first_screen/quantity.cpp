#include "analysis/report/first_screen/quantity.hpp"

#include "analysis/text/quantity.hpp"

namespace zerocount::report {
namespace {

/// Without places for a line break but behind a comma and beside "…".
std::string unbroken(std::string text) {
  constexpr std::string_view no_break_space = "\u00a0", to = "…";
  const auto may_break = [&](std::size_t at) {
    const std::string_view before = std::string_view(text).substr(0, at);
    return before.ends_with(',') || before.ends_with(to) ||
           std::string_view(text).substr(at + 1).starts_with(to);
  };
  for (std::size_t at = text.find(' '); at != std::string::npos; at = text.find(' ', at + 1))
    if (!may_break(at)) text.replace(at, 1, no_break_space);
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
