#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "core/text/text.hpp"

namespace zerocount::text {

namespace {

constexpr double rounding = 1e-9;  // of the last digit: 99.9 % with a rounding error is shown as 99.9 %
constexpr int max_decimals = 9;

/// Number of decimals with which a percentage shows two significant digits; one decimal from 1 % on.
int percent_decimals(double percent) {
  if (!(percent > 0.0)) return 1;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(percent) + rounding)), 1, max_decimals);
}

/// A percentage as text with at most `decimals` decimals, without trailing zeros: "12.5 %".
std::string percent_with(double percent, int decimals) {
  std::string number = fmt::format("{:.{}f}", percent, decimals);
  number.erase(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  return number + " %";
}

double floor_to(double value, int decimals) {
  const double unit = std::pow(10.0, decimals);
  return std::floor(value * unit + rounding) / unit;
}

}  // namespace

std::string percent(double proportion) {
  const double distance = std::min(std::abs(proportion), std::abs(1.0 - proportion));
  for (int digits = 4; digits < 17; ++digits) {
    const double read = round_to_digits(100.0 * proportion, digits) / 100.0;
    if (std::abs(read - proportion) <= std::max(1e-6 * distance, 1e-16))
      return fmt::format("{:.{}g} %", 100.0 * proportion, digits);
  }
  return fmt::format("{} %", 100.0 * proportion);
}

std::string percent_near(double proportion) {
  if (std::isnan(proportion)) return "–";
  if (proportion == 0.0 || proportion == 1.0) return proportion == 0.0 ? "0 %" : "100 %";
  const double percent = 100.0 * proportion;
  return fmt::format("{:.{}f} %", percent, std::max(1, percent_decimals(std::min(percent, 100.0 - percent))));
}

std::string percent_at_least(double proportion) {
  const double percent = 100.0 * proportion;
  const int decimals = percent_decimals(std::min(percent, 100.0 - percent));
  const double highest = 100.0 - std::pow(10.0, -max_decimals);
  if (percent >= highest) return percent_with(highest, max_decimals);
  return percent_with(floor_to(percent, decimals), decimals);
}

std::string percent_at_most(double proportion) {
  const double percent = 100.0 * proportion;
  const int decimals = percent_decimals(percent);
  const double lowest = std::pow(10.0, -max_decimals);
  if (percent > 0.0 && percent <= lowest) return percent_with(lowest, max_decimals);
  return percent_with(percent > 0.0 ? -floor_to(-percent, decimals) : 0.0, decimals);
}

std::string rounded_down(double value, int decimals) {
  const double rounded = floor_to(value, decimals);
  return fmt::format("{:.{}f}", rounded == 0.0 ? 0.0 : rounded, decimals);
}

std::string rounded_up(double value, int decimals) {
  const double rounded = -floor_to(-value, decimals);
  return fmt::format("{:.{}f}", rounded == 0.0 ? 0.0 : rounded, decimals);
}

std::string percent_bounds(double low, double high, int decimals, const char* between) {
  return rounded_down(100.0 * low, decimals) + between + rounded_up(100.0 * high, decimals);
}

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
