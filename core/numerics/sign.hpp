#pragma once

#include <concepts>

namespace zerocount::numerics {

/// Sign of a number: −1, 0 or 1.
template <class Number>
requires std::floating_point<Number> || std::signed_integral<Number>
constexpr int sign_of(Number value) {
  return (value > Number{0}) - (value < Number{0});
}

}  // namespace zerocount::numerics
