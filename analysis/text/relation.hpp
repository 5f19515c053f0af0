#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

/// Texts such as "settling_time > 0.5" and "success_rate ≥ 0.995": what options and margins ask of a value.
namespace zerocount::text {

/// How a value lies to its limit.
enum class Sign : std::uint8_t { below, at_most, above, at_least, equal, unequal };

/// The parts of such a text, without the blanks around them.
struct Relation {
  std::string_view name;
  Sign sign;
  std::string_view written;  ///< the sign as it stands: "≥" or ">="
  std::string_view limit;
};

/// The parts of the text by the first sign in it, one of < <= ≤ > >= ≥ = == != ≠; nothing without one.
std::optional<Relation> parse_relation(std::string_view text);

/// Whether the value lies so; never of NaN.
bool holds(Sign sign, double value, double limit);

}  // namespace zerocount::text
