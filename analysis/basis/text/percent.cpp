#include <algorithm>
#include <cmath>

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

}  // namespace zerocount::text
