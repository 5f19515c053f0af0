#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "analysis/basis/text/text.hpp"
#include "core/text/relation.hpp"
#include "core/text/text.hpp"

namespace zerocount::text {
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

std::vector<double> values_as_written(Relation relation, std::vector<double> values, std::string_view limit) {
  const std::optional<double> number = parse_number<double>(limit);
  if (!number || std::ranges::find(values, *number) != values.end()) return values;
  const bool by_equality = relation == Relation::equal || relation == Relation::unequal;
  const int written = std::min(significant_digits(limit), std::numeric_limits<double>::max_digits10);
  const int digits = by_equality ? written : std::max(written, short_digits);
  for (double& value : values) {
    if (std::isfinite(value) && round_to_digits(value, digits) == *number) value = *number;
  }
  return values;
}

}  // namespace zerocount::text
