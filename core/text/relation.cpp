#include "core/text/relation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/text/text.hpp"

namespace zerocount::text {
namespace {

/// The signs as users write them. A sign that begins with another sign comes before it in the list.
constexpr std::array<std::pair<std::string_view, Relation>, 10> signs{{{"<=", Relation::at_most},
                                                                       {"≤", Relation::at_most},
                                                                       {"<", Relation::below},
                                                                       {">=", Relation::at_least},
                                                                       {"≥", Relation::at_least},
                                                                       {">", Relation::above},
                                                                       {"!=", Relation::unequal},
                                                                       {"≠", Relation::unequal},
                                                                       {"==", Relation::equal},
                                                                       {"=", Relation::equal}}};

}  // namespace

bool holds(Relation relation, double value, double limit) {
  switch (relation) {
    case Relation::below:
      return value < limit;
    case Relation::at_most:
      return value <= limit;
    case Relation::above:
      return value > limit;
    case Relation::at_least:
      return value >= limit;
    case Relation::equal:
      return value == limit;
    case Relation::unequal:
      return value < limit || value > limit;
  }
  return false;
}

std::string_view sign_of(Relation relation) {
  switch (relation) {
    case Relation::below:
      return "<";
    case Relation::at_most:
      return "≤";
    case Relation::above:
      return ">";
    case Relation::at_least:
      return "≥";
    case Relation::equal:
      return "=";
    case Relation::unequal:
      return "≠";
  }
  return "";
}

Relation negation(Relation relation) {
  switch (relation) {
    case Relation::below:
      return Relation::at_least;
    case Relation::at_most:
      return Relation::above;
    case Relation::above:
      return Relation::at_most;
    case Relation::at_least:
      return Relation::below;
    case Relation::equal:
      return Relation::unequal;
    case Relation::unequal:
      return Relation::equal;
  }
  return relation;
}

std::optional<Comparison> parse_comparison(std::string_view text) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto found = std::ranges::find_if(
        signs, [rest = text.substr(at)](const auto& sign) { return rest.starts_with(sign.first); });
    if (found == signs.end()) continue;
    return Comparison{trimmed(text.substr(0, at)), found->second, found->first,
                      trimmed(text.substr(at + found->first.size()))};
  }
  return std::nullopt;
}

std::optional<Limit> limit_of(const Comparison& comparison) {
  const std::optional<double> value = parse_number<double>(comparison.limit);
  if (!value || !std::isfinite(*value)) return std::nullopt;
  return Limit{comparison.relation, *value};
}

}  // namespace zerocount::text
