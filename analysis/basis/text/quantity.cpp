#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "core/text/text.hpp"

namespace zerocount::text {
namespace {

struct Prefix {
  double factor;
  std::string_view symbol;
};

constexpr std::array small_prefixes{Prefix{1e-12, "p"}, Prefix{1e-9, "n"}, Prefix{1e-6, "µ"},
                                    Prefix{1e-3, "m"}, Prefix{1.0, ""}};
constexpr std::array large_prefixes{Prefix{1.0, ""}, Prefix{1e3, "k"}, Prefix{1e6, "M"}};

/// The SI prefixes that are usual with a unit, by the part of the unit before '/' or '^': none, small ones
/// (m, rad, s) or large ones (Hz).
std::span<const Prefix> prefixes_of(std::string_view unit) {
  const std::string_view first = unit.substr(0, unit.find_first_of("/^"));
  if (unit.find('^') < unit.find('/')) return {};  // a prefix would be squared too
  if (first == "m" || first == "rad" || first == "s") return small_prefixes;
  if (first == "Hz") return large_prefixes;
  return {};
}

/// The largest usual prefix with which the number is at least 1, or the smallest prefix if there is none. No
/// prefix for 0 and for units without prefixes.
Prefix prefix_for(double largest, std::string_view unit) {
  const std::span<const Prefix> prefixes = prefixes_of(unit);
  Prefix chosen =
      prefixes.empty() || !(largest > 0.0) || !std::isfinite(largest) ? Prefix{1.0, ""} : prefixes.front();
  for (const Prefix& one : prefixes) {
    if (largest > 0.0 && std::isfinite(largest) && largest >= 0.9999 * one.factor) chosen = one;
  }
  return chosen;
}

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

/// Whether the unit is a word with a plural: count or sample.
bool is_counted(std::string_view unit) {
  return unit == "count" || unit == "sample";
}

/// The unit as text after a number: " nm", " m/s²"; empty without a unit.
/// @param value last number before the unit
std::string unit_text(std::string_view prefix, std::string_view unit, double value) {
  if (unit.empty() || unit == "1") return "";
  std::string text = fmt::format(" {}{}{}", prefix, unit, is_counted(unit) && value != 1.0 ? "s" : "");
  replace_all(text, "^2", "²");
  replace_all(text, "^3", "³");
  return text;
}

}  // namespace

std::string number_text(double value, int digits) {
  std::string text = std::isnan(value) ? "–" : fmt::format("{:.{}g}", value, digits);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  std::size_t begin = exponent + 2;
  while (begin + 1 < text.size() && text[begin] == '0') text.erase(begin, 1);
  if (text[exponent + 1] == '+') text.erase(exponent + 1, 1);
  return text;
}

std::string quantity_text(double value, std::string_view unit, int digits) {
  const Prefix prefix = prefix_for(std::abs(value), unit);
  return number_text(value / prefix.factor, digits) + unit_text(prefix.symbol, unit, value);
}

std::string list_text(std::span<const double> values, std::string_view unit) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  const Prefix prefix = prefix_for(largest, unit);
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + number_text(value / prefix.factor);
  return text + unit_text(prefix.symbol, unit, values.empty() ? 0.0 : values.back());
}

std::string range_text(double low, double high, std::string_view unit) {
  const Prefix prefix = prefix_for(std::max(std::abs(low), std::abs(high)), unit);
  const std::string first = number_text(low / prefix.factor);
  const std::string last = number_text(high / prefix.factor);
  return (first == last ? first : first + " … " + last) + unit_text(prefix.symbol, unit, high);
}

}  // namespace zerocount::text
