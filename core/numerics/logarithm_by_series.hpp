#pragma once

#include "core/numerics/number.hpp"

namespace zerocount::numerics {

/// ln 2 as a sum. The first term is a multiple of 2⁻⁴², so its multiples up to 2¹⁰ are exact.
inline constexpr double ln2_high = 0x1.62e42fefa3800p-1;
inline constexpr double ln2_low = 0x1.ef35793c76730p-45;

/// Natural logarithm ln a of a normal number a > 0, to some 2e-16 relative: a = m·2ᵉ with m from √½ to √2,
/// and with s = (m − 1)/(m + 1) ln m = 2·(s + s³/3 + s⁵/5 + …).
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number logarithm_by_series(const Number& a) {
  Number m, e;
  split(a, m, e);
  const auto large = m > Number(0x1.6a09e667f3bcdp0);  // √2
  m = select(large, Number(0.5) * m, m);
  e = select(large, e + Number(1.0), e);
  const Number s = (m - Number(1.0)) / (m + Number(1.0));
  const Number square = s * s;
  Number sum(1.0 / 21.0);
  for (int odd = 19; odd >= 3; odd -= 2) sum = sum * square + Number(1.0 / odd);
  return e * Number(ln2_high) + (e * Number(ln2_low) + Number(2.0) * (s + s * (square * sum)));
}

}  // namespace zerocount::numerics
