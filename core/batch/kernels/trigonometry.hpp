#pragma once

#include "core/batch/kernels/simd.hpp"

namespace zerocount::batch {

/// sin x and cos x to about 2e-16 + 2e-16·|x| for |x| < 2⁵⁰: x − n·π/2 by Cody and Waite's reduction, and
/// series about 0.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void sine_and_cosine(const P& x, P& sine, P& cosine) {
  using Mask = typename P::Mask;
  const P n = fast_rint(x * P(0x1.45f306dc9c883p-1));  // 2/π
  // π/2 in three parts, of which the first two have 33 bits.
  const P r =
      ((x - n * P(0x1.921fb54400000p+0)) - n * P(0x1.0b4611a600000p-34)) - n * P(0x1.3198a2e037073p-69);
  const P square = r * r;
  constexpr double of_sine[] = {1.0 / 1307674368000.0, 1.0 / 6227020800.0, 1.0 / 39916800.0, 1.0 / 362880.0,
                                1.0 / 5040.0,          1.0 / 120.0,        1.0 / 6.0};
  constexpr double of_cosine[] = {
      1.0 / 20922789888000.0, 1.0 / 87178291200.0, 1.0 / 479001600.0, 1.0 / 3628800.0,
      1.0 / 40320.0,          1.0 / 720.0,         1.0 / 24.0,        0.5};
  P s(-of_sine[0]);
  for (int i = 1; i < 7; ++i) s = P(i % 2 == 0 ? -of_sine[i] : of_sine[i]) + s * square;
  P c(of_cosine[0]);
  for (int i = 1; i < 8; ++i) c = P(i % 2 == 0 ? of_cosine[i] : -of_cosine[i]) + c * square;
  s = r + r * (square * s);
  c = P(1.0) + square * c;
  const P quarter = n - P(4.0) * floor(n * P(0.25));
  const Mask exchanged = (quarter == P(1.0)) | (quarter == P(3.0));
  const P first = select(exchanged, c, s);
  const P second = select(exchanged, s, c);
  sine = select(quarter > P(1.5), -first, first);
  cosine = select((quarter == P(1.0)) | (quarter == P(2.0)), -second, second);
}

}  // namespace zerocount::batch
