#pragma once

#include <cstdint>

#include "core/numerics/number.hpp"

/// Vectors of doubles for the kernels of the batch engine, by the vector extension of GCC and Clang.
///
/// A Simd is `Chains` vectors of `Width` doubles that go through the same operations side by side, so that
/// the latency of one vector's operation is filled with the others'. All operations are those of IEEE
/// arithmetic, element by element: what comes of a lane depends neither on width and chains nor on other
/// lanes.
///
/// This header and the kernels are compiled once for each instruction set: see core/numerics/number.hpp for
/// what they must not include.
namespace zerocount::batch {

template <int Width>
struct VectorOf {
  typedef double Real __attribute__((vector_size(8 * Width)));
  typedef std::int64_t Bits __attribute__((vector_size(8 * Width)));
};

/// Mask by lane: all bits set, or none.
template <int Width, int Chains>
struct SimdMask {
  using Bits = typename VectorOf<Width>::Bits;
  Bits part[Chains];

  ZEROCOUNT_ALWAYS_INLINE bool any() const {
    Bits all = part[0];
    for (int i = 1; i < Chains; ++i) all |= part[i];
    std::int64_t found = 0;
    for (int j = 0; j < Width; ++j) found |= all[j];
    return found != 0;
  }
  friend ZEROCOUNT_ALWAYS_INLINE SimdMask operator&(const SimdMask& a, const SimdMask& b) {
    SimdMask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = a.part[i] & b.part[i];
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE SimdMask operator|(const SimdMask& a, const SimdMask& b) {
    SimdMask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = a.part[i] | b.part[i];
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE SimdMask operator==(const SimdMask& a, const SimdMask& b) {
    SimdMask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = ~(a.part[i] ^ b.part[i]);
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE SimdMask operator~(const SimdMask& a) {
    SimdMask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = ~a.part[i];
    return r;
  }
};

template <int Width, int Chains>
struct Simd {
  using Real = typename VectorOf<Width>::Real;
  using Bits = typename VectorOf<Width>::Bits;
  using Mask = SimdMask<Width, Chains>;
  static constexpr int lanes = Width * Chains;
  Real part[Chains];

  Simd() = default;
  ZEROCOUNT_ALWAYS_INLINE Simd(double value) {  // NOLINT(google-explicit-constructor)
    for (int i = 0; i < Chains; ++i) part[i] = value - Real{};
  }

  friend ZEROCOUNT_ALWAYS_INLINE Simd operator+(const Simd& a, const Simd& b) {
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = a.part[i] + b.part[i];
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Simd operator-(const Simd& a, const Simd& b) {
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = a.part[i] - b.part[i];
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Simd operator*(const Simd& a, const Simd& b) {
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = a.part[i] * b.part[i];
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Simd operator/(const Simd& a, const Simd& b) {
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = a.part[i] / b.part[i];
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Simd operator-(const Simd& a) {
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = -a.part[i];
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Mask operator<(const Simd& a, const Simd& b) {
    Mask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = a.part[i] < b.part[i];
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Mask operator<=(const Simd& a, const Simd& b) {
    Mask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = a.part[i] <= b.part[i];
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Mask operator>(const Simd& a, const Simd& b) { return b < a; }
  friend ZEROCOUNT_ALWAYS_INLINE Mask operator>=(const Simd& a, const Simd& b) { return b <= a; }
  friend ZEROCOUNT_ALWAYS_INLINE Mask operator==(const Simd& a, const Simd& b) {
    Mask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = a.part[i] == b.part[i];
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Mask operator!=(const Simd& a, const Simd& b) { return ~(a == b); }

  /// a where `mask`, else b.
  friend ZEROCOUNT_ALWAYS_INLINE Simd select(const Mask& mask, const Simd& a, const Simd& b) {
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = mask.part[i] ? a.part[i] : b.part[i];
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Simd abs(const Simd& a) {
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = (Real)((Bits)a.part[i] & INT64_MAX);
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Simd min(const Simd& a, const Simd& b) { return select(b < a, b, a); }
  friend ZEROCOUNT_ALWAYS_INLINE Simd max(const Simd& a, const Simd& b) { return select(a < b, b, a); }
  /// −1, 0 or 1.
  friend ZEROCOUNT_ALWAYS_INLINE Simd sign(const Simd& a) {
    return select(a > Simd(0.0), Simd(1.0), select(a < Simd(0.0), Simd(-1.0), Simd(0.0)));
  }

  /// √a.
  friend ZEROCOUNT_ALWAYS_INLINE Simd sqrt(const Simd& a) {
    Simd r;
    for (int i = 0; i < Chains; ++i) {
      for (int j = 0; j < Width; ++j) r.part[i][j] = __builtin_sqrt(a.part[i][j]);
    }
    return r;
  }

  /// aⁿ for a ≥ 0, lane by lane by the C library.
  friend ZEROCOUNT_ALWAYS_INLINE Simd pow(const Simd& a, const Simd& n) {
    Simd r;
    for (int i = 0; i < Chains; ++i) {
      for (int j = 0; j < Width; ++j) r.part[i][j] = __builtin_pow(a.part[i][j], n.part[i][j]);
    }
    return r;
  }

  /// The nearest whole number, half to even. |a| < 2⁵¹.
  friend ZEROCOUNT_ALWAYS_INLINE Simd fast_rint(const Simd& a) {
    const Simd shift(0x1.8p52);
    return (a + shift) - shift;
  }
  /// The same of any a; from 2⁵⁰ on, where no one asks for more, a itself.
  friend ZEROCOUNT_ALWAYS_INLINE Simd rint(const Simd& a) {
    return select(abs(a) < Simd(0x1p50), fast_rint(a), a);
  }
  /// ⌊a⌋, |a| < 2⁵¹.
  friend ZEROCOUNT_ALWAYS_INLINE Simd floor(const Simd& a) {
    const Simd nearest = fast_rint(a);
    return select(nearest > a, nearest - Simd(1.0), nearest);
  }
  /// 2ᵃ, a a whole number from −1022 to 1023.
  friend ZEROCOUNT_ALWAYS_INLINE Simd exp2(const Simd& a) {
    const Simd shifted = a + Simd(0x1.8p52);
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = (Real)(((Bits)shifted.part[i] + 1023) << 52);
    return r;
  }
  /// 2 to the power log₂(a)·fraction, within 7 %, for positive normal a: its bits, taken as a number, are
  /// about its logarithm.
  friend ZEROCOUNT_ALWAYS_INLINE Simd rough_power(const Simd& a, double fraction) {
    const Simd shift(0x1.8p52);
    Simd r;
    for (int i = 0; i < Chains; ++i) {
      // The upper 32 bits are enough, and are exact as a double.
      const Bits upper = ((Bits)a.part[i] >> 32);
      const Real logarithm = (Real)(upper + (Bits)shift.part[i]) - shift.part[i];
      constexpr double of_one = 1072693248.0;  // upper bits of 1.0
      const Real power = (logarithm - of_one) * fraction + of_one;
      r.part[i] = (Real)((Bits)(power + shift.part[i]) << 32);
    }
    return r;
  }
};

/// eᵃ for a ≤ 700, to some 2e-16 relative; of a < −700, e⁻⁷⁰⁰.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P exp(const P& a) {
  const P x = max(a, P(-700.0));
  const P n = fast_rint(x * P(0x1.71547652b82fep0));                             // x/ln 2
  const P r = (x - n * P(0x1.62e42fefa3800p-1)) - n * P(0x1.ef35793c76730p-45);  // ln 2 in two parts
  constexpr double factorials[] = {1.0 / 6227020800.0, 1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0,
                                   1.0 / 362880.0,     1.0 / 40320.0,     1.0 / 5040.0,     1.0 / 720.0,
                                   1.0 / 120.0,        1.0 / 24.0,        1.0 / 6.0,        0.5};
  P sum(factorials[0]);
  for (int i = 1; i < 12; ++i) sum = sum * r + P(factorials[i]);
  return (P(1.0) + (r + (r * r) * sum)) * exp2(n);
}

}  // namespace zerocount::batch
