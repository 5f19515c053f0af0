#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "analysis/text/text.hpp"
#include "core/text/text.hpp"

namespace zerocount::text {
namespace {

/// A sign that begins with another one stands before it.
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

}  // namespace zerocount::text
