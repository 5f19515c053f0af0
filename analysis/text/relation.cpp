#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/text/text.hpp"
#include "core/text/text.hpp"

namespace zerocount::text {
namespace {

/// The relation signs as users write them. A sign that begins with another sign comes before it in the list.
constexpr std::array<std::pair<std::string_view, Sign>, 10> signs{{{"<=", Sign::at_most},
                                                                   {"≤", Sign::at_most},
                                                                   {"<", Sign::below},
                                                                   {">=", Sign::at_least},
                                                                   {"≥", Sign::at_least},
                                                                   {">", Sign::above},
                                                                   {"!=", Sign::unequal},
                                                                   {"≠", Sign::unequal},
                                                                   {"==", Sign::equal},
                                                                   {"=", Sign::equal}}};

}  // namespace

std::optional<Relation> parse_relation(std::string_view text) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto found = std::ranges::find_if(
        signs, [rest = text.substr(at)](const auto& sign) { return rest.starts_with(sign.first); });
    if (found == signs.end()) continue;
    return Relation{trimmed(text.substr(0, at)), found->second, found->first,
                    trimmed(text.substr(at + found->first.size()))};
  }
  return std::nullopt;
}

bool holds(Sign sign, double value, double limit) {
  switch (sign) {
    case Sign::below:
      return value < limit;
    case Sign::at_most:
      return value <= limit;
    case Sign::above:
      return value > limit;
    case Sign::at_least:
      return value >= limit;
    case Sign::equal:
      return value == limit;
    case Sign::unequal:
      return value < limit || value > limit;
  }
  return false;
}

namespace {

/// Number of significant digits in which a number is written: 6 in "11767.7", 2 in "2.0e4", 1 in "0.003".
int significant_digits(std::string_view number) {
  const std::string_view mantissa = number.substr(0, number.find_first_of("eE"));
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return 1;
  return static_cast<int>(std::ranges::count_if(
      mantissa.substr(first), [](char character) { return character >= '0' && character <= '9'; }));
}

}  // namespace

std::vector<double> values_as_written(Sign sign, std::vector<double> values, std::string_view limit) {
  const std::optional<double> number = parse_number<double>(limit);
  if (!number || std::ranges::find(values, *number) != values.end()) return values;
  const bool by_equality = sign == Sign::equal || sign == Sign::unequal;
  const int written = std::min(significant_digits(limit), std::numeric_limits<double>::max_digits10);
  const int digits = by_equality ? written : std::max(written, short_digits);
  for (double& value : values) {
    if (std::isfinite(value) && round_to_digits(value, digits) == *number) value = *number;
  }
  return values;
}

}  // namespace zerocount::text
