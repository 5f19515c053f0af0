#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

/// Relations between a value and a limit, and texts such as "arrival_time > 0.5" and "success_rate ≥ 0.995".
namespace zerocount::text {

/// Relation of a value to a limit.
enum class Relation : std::uint8_t { below, at_most, above, at_least, equal, unequal };

/// Whether the value has this relation to the limit; false for NaN.
bool holds(Relation relation, double value, double limit);

/// The relation that a number has to a limit exactly if it does not have `relation` to it: "above" for
/// "at most".
Relation negation(Relation relation);

/// Whether the relation bounds values from below, as in "at least 0.9".
constexpr bool is_lower_limit(Relation relation) {
  return relation == Relation::above || relation == Relation::at_least;
}

/// The sign of a relation in messages and tables: "≤" for at_most.
std::string_view sign_of(Relation relation);

/// A limit that a value must keep, such as "at most 0.5".
struct Limit {
  Relation relation{Relation::at_most};
  double value{0.0};  ///< The limit itself, in the unit of the limited value.
};

/// Whether the value keeps the limit; false for NaN.
inline bool keeps(double value, const Limit& limit) {
  return holds(limit.relation, value, limit.value);
}

/// The limit that a number keeps exactly if it does not keep `limit`.
inline Limit negation(const Limit& limit) {
  return {negation(limit.relation), limit.value};
}

/// The parts of a text such as "arrival_time > 0.5", without the blanks around them.
struct Comparison {
  std::string_view name;
  Relation relation;
  std::string_view written;  ///< The sign as written in the text: "≥" or ">=".
  std::string_view limit;
};

/// Splits the text at the first relation sign in it, one of < <= ≤ > >= ≥ = == != ≠; nothing without one.
std::optional<Comparison> parse_comparison(std::string_view text);

/// The limit of the comparison; nothing unless it is written as a finite number.
std::optional<Limit> limit_of(const Comparison& comparison);

}  // namespace zerocount::text
