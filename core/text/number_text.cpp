#include "core/text/number_text.hpp"

#include <fmt/format.h>

namespace zerocount::text {

double round_to_digits(double value, int digits) {
  return parse_number<double>(fmt::format("{:.{}g}", value, digits)).value_or(value);
}

}  // namespace zerocount::text
