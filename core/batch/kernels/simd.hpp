#pragma once

#include <cstddef>
#include <cstdint>

#ifdef __SSE2__
#include <immintrin.h>
#endif

#include "core/numerics/logarithm_by_series.hpp"
#include "core/numerics/number.hpp"

/// Vectors of doubles for the kernels of the batch engine, by the vector extension of GCC and Clang.
///
/// A Simd is `Chains` vectors of `Width` doubles that go through the same operations side by side, so that
/// the latency of one vector's operation is filled with the operations of the others. All operations follow
/// IEEE arithmetic, element by element: the result of a lane depends neither on width and chains nor on other
/// lanes.
///
/// This header and the kernels are compiled once for each instruction set: see core/numerics/number.hpp for
/// what they must not include.
namespace zerocount::batch {

/// One vector of `Width` doubles, its masks, and the operations that differ between instruction sets.
template <int Width>
struct VectorOf {
  typedef double Real __attribute__((vector_size(8 * Width)));
  typedef std::int64_t Bits __attribute__((vector_size(8 * Width)));
  /// Mask of a vector: for each lane all bits are set, or none.
  typedef std::int64_t Mask __attribute__((vector_size(8 * Width)));

  static ZEROCOUNT_ALWAYS_INLINE Mask less(Real a, Real b) { return a < b; }
  static ZEROCOUNT_ALWAYS_INLINE Mask less_or_equal(Real a, Real b) { return a <= b; }
  static ZEROCOUNT_ALWAYS_INLINE Mask equal(Real a, Real b) { return a == b; }
  static ZEROCOUNT_ALWAYS_INLINE Real select(Mask mask, Real a, Real b) { return mask ? a : b; }
  static ZEROCOUNT_ALWAYS_INLINE Real sqrt(Real a) {
#ifdef __AVX__
    if constexpr (Width == 4) return (Real)_mm256_sqrt_pd((__m256d)a);
#endif
#ifdef __SSE2__
    if constexpr (Width == 2) return (Real)_mm_sqrt_pd((__m128d)a);
#endif
    double lane[Width];
    __builtin_memcpy(lane, &a, sizeof lane);
    for (int j = 0; j < Width; ++j) lane[j] = __builtin_sqrt(lane[j]);
    __builtin_memcpy(&a, lane, sizeof lane);
    return a;
  }
  /// Product of the lower 32 bits of a and b in each lane.
  static ZEROCOUNT_ALWAYS_INLINE Bits product_of_words(Bits a, Bits b) {
#ifdef __AVX2__
    if constexpr (Width == 4) return (Bits)_mm256_mul_epu32((__m256i)a, (__m256i)b);
#endif
#ifdef __SSE2__
    if constexpr (Width == 2) return (Bits)_mm_mul_epu32((__m128i)a, (__m128i)b);
#endif
    return (a & UINT32_MAX) * (b & UINT32_MAX);
  }
  static ZEROCOUNT_ALWAYS_INLINE void store(double* to, Mask mask, Real value) {
    Real kept;
    __builtin_memcpy(&kept, to, sizeof kept);
    kept = mask ? value : kept;
    __builtin_memcpy(to, &kept, sizeof kept);
  }
  /// The mask as an integer: one bit for each lane, the lowest lane in the lowest bit.
  static ZEROCOUNT_ALWAYS_INLINE unsigned bits(Mask mask) {
#ifdef __AVX__
    if constexpr (Width == 4) return static_cast<unsigned>(_mm256_movemask_pd((__m256d)mask));
#endif
#ifdef __SSE2__
    if constexpr (Width == 2) return static_cast<unsigned>(_mm_movemask_pd((__m128d)mask));
#endif
    std::int64_t lane[Width];
    __builtin_memcpy(lane, &mask, sizeof lane);
    unsigned bits = 0;
    for (int j = 0; j < Width; ++j) bits |= static_cast<unsigned>(lane[j] & 1) << j;
    return bits;
  }
  static ZEROCOUNT_ALWAYS_INLINE Mask of_bits(unsigned bits) {
    std::int64_t lane[Width];
    for (int j = 0; j < Width; ++j) lane[j] = std::int64_t{1} << j;
    Bits bit;
    __builtin_memcpy(&bit, lane, sizeof bit);
    return (bit & static_cast<std::int64_t>(bits)) == bit;
  }
};

#ifdef __AVX512F__
/// Vector of eight doubles, with the mask registers of AVX-512.
template <>
struct VectorOf<8> {
  typedef double Real __attribute__((vector_size(64)));
  typedef std::int64_t Bits __attribute__((vector_size(64)));
  using Mask = __mmask8;  ///< Mask of a vector, one bit per lane

  static ZEROCOUNT_ALWAYS_INLINE Mask less(Real a, Real b) {
    return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ);
  }
  static ZEROCOUNT_ALWAYS_INLINE Mask less_or_equal(Real a, Real b) {
    return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LE_OQ);
  }
  static ZEROCOUNT_ALWAYS_INLINE Mask equal(Real a, Real b) {
    return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_EQ_OQ);
  }
  static ZEROCOUNT_ALWAYS_INLINE Real select(Mask mask, Real a, Real b) {
    return (Real)_mm512_mask_blend_pd(mask, (__m512d)b, (__m512d)a);
  }
  static ZEROCOUNT_ALWAYS_INLINE Real sqrt(Real a) { return (Real)_mm512_sqrt_pd((__m512d)a); }
  /// Product of the lower 32 bits of a and b in each lane.
  static ZEROCOUNT_ALWAYS_INLINE Bits product_of_words(Bits a, Bits b) {
    return (Bits)_mm512_mul_epu32((__m512i)a, (__m512i)b);
  }
  static ZEROCOUNT_ALWAYS_INLINE void store(double* to, Mask mask, Real value) {
    _mm512_mask_storeu_pd(to, mask, (__m512d)value);
  }
  static ZEROCOUNT_ALWAYS_INLINE unsigned bits(Mask mask) { return mask; }
  static ZEROCOUNT_ALWAYS_INLINE Mask of_bits(unsigned bits) { return static_cast<Mask>(bits); }
};
#endif

/// Mask of a Simd: for each lane whether it is selected.
template <int Width, int Chains>
struct SimdMask {
  using Vector = VectorOf<Width>;
  using Part = typename Vector::Mask;
  Part part[Chains];

  /// The mask that selects the lanes whose bit is set; the lowest lane has the lowest bit.
  static ZEROCOUNT_ALWAYS_INLINE SimdMask of_bits(unsigned bits) {
    SimdMask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = Vector::of_bits(bits >> (i * Width));
    return r;
  }
  /// The mask as an integer: one bit for each lane, the lowest lane in the lowest bit.
  ZEROCOUNT_ALWAYS_INLINE unsigned bits() const {
    unsigned bits = 0;
    for (int i = 0; i < Chains; ++i) bits |= Vector::bits(part[i]) << (i * Width);
    return bits;
  }
  ZEROCOUNT_ALWAYS_INLINE bool any() const {
    Part all = part[0];
    for (int i = 1; i < Chains; ++i) all |= part[i];
    return Vector::bits(all) != 0;
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
  friend ZEROCOUNT_ALWAYS_INLINE SimdMask operator~(const SimdMask& a) {
    SimdMask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = static_cast<Part>(~a.part[i]);
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE SimdMask operator==(const SimdMask& a, const SimdMask& b) {
    SimdMask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = static_cast<Part>(~(a.part[i] ^ b.part[i]));
    return r;
  }
};

template <int Width, int Chains>
ZEROCOUNT_ALWAYS_INLINE bool any(const SimdMask<Width, Chains>& mask) {
  return mask.any();
}
template <int Width, int Chains>
ZEROCOUNT_ALWAYS_INLINE SimdMask<Width, Chains> negated(const SimdMask<Width, Chains>& mask) {
  return ~mask;
}

template <int Width, int Chains>
struct Simd {
  using Vector = VectorOf<Width>;
  using Real = typename Vector::Real;
  using Bits = typename Vector::Bits;
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
    for (int i = 0; i < Chains; ++i) r.part[i] = Vector::less(a.part[i], b.part[i]);
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Mask operator<=(const Simd& a, const Simd& b) {
    Mask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = Vector::less_or_equal(a.part[i], b.part[i]);
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Mask operator>(const Simd& a, const Simd& b) { return b < a; }
  friend ZEROCOUNT_ALWAYS_INLINE Mask operator>=(const Simd& a, const Simd& b) { return b <= a; }
  friend ZEROCOUNT_ALWAYS_INLINE Mask operator==(const Simd& a, const Simd& b) {
    Mask r;
    for (int i = 0; i < Chains; ++i) r.part[i] = Vector::equal(a.part[i], b.part[i]);
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Mask operator!=(const Simd& a, const Simd& b) { return ~(a == b); }

  /// Writes the elements of the lanes in `mask` to memory from `to` on; the other elements in memory keep
  /// their values.
  ZEROCOUNT_ALWAYS_INLINE void store(double* to, const Mask& mask) const {
    for (int i = 0; i < Chains; ++i) Vector::store(to + std::ptrdiff_t{i} * Width, mask.part[i], part[i]);
  }
  /// Selects for each lane: a in the lanes of `mask`, b in the others.
  friend ZEROCOUNT_ALWAYS_INLINE Simd select(const Mask& mask, const Simd& a, const Simd& b) {
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = Vector::select(mask.part[i], a.part[i], b.part[i]);
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Simd abs(const Simd& a) {
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = (Real)((Bits)a.part[i] & INT64_MAX);
    return r;
  }
  friend ZEROCOUNT_ALWAYS_INLINE Simd min(const Simd& a, const Simd& b) { return select(b < a, b, a); }
  friend ZEROCOUNT_ALWAYS_INLINE Simd max(const Simd& a, const Simd& b) { return select(a < b, b, a); }
  /// a·(1/b). The compiler can compute the reciprocal once for all a with the same b.
  friend ZEROCOUNT_ALWAYS_INLINE Simd by_fixed(const Simd& a, const Simd& b) { return a * (Simd(1.0) / b); }
  /// Sign of a: −1, 0 or 1.
  friend ZEROCOUNT_ALWAYS_INLINE Simd sign(const Simd& a) {
    return select(a > Simd(0.0), Simd(1.0), select(a < Simd(0.0), Simd(-1.0), Simd(0.0)));
  }

  /// Square root of a.
  friend ZEROCOUNT_ALWAYS_INLINE Simd sqrt(const Simd& a) {
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = Vector::sqrt(a.part[i]);
    return r;
  }

  /// Rounds a to the nearest whole number, half to even; only for |a| < 2⁵¹.
  friend ZEROCOUNT_ALWAYS_INLINE Simd fast_rint(const Simd& a) {
    const Simd shift(0x1.8p52);
    return (a + shift) - shift;
  }
  /// Rounds a to the nearest whole number, half to even; returns a unchanged for abs(a) ≥ 2⁵⁰.
  friend ZEROCOUNT_ALWAYS_INLINE Simd rint(const Simd& a) {
    return select(abs(a) < Simd(0x1p50), fast_rint(a), a);
  }
  /// Largest whole number that does not exceed a, for |a| < 2⁵¹.
  friend ZEROCOUNT_ALWAYS_INLINE Simd floor(const Simd& a) {
    const Simd nearest = fast_rint(a);
    return select(nearest > a, nearest - Simd(1.0), nearest);
  }
  /// The power of two 2ᵃ for a whole number a from −1022 to 1023.
  friend ZEROCOUNT_ALWAYS_INLINE Simd exp2(const Simd& a) {
    const Simd shifted = a + Simd(0x1.8p52);
    Simd r;
    for (int i = 0; i < Chains; ++i) r.part[i] = (Real)(((Bits)shifted.part[i] + 1023) << 52);
    return r;
  }
  /// Splits a normal number a > 0 into the factors of a = m·2ᵉ with 1 ≤ m < 2.
  friend ZEROCOUNT_ALWAYS_INLINE void split(const Simd& a, Simd& m, Simd& e) {
    typedef std::uint64_t Unsigned __attribute__((vector_size(8 * Width)));
    constexpr int stored_bits = 52;
    constexpr std::int64_t of_one = std::int64_t{1023} << stored_bits;  // bits of 1.0
    const Simd shift(0x1.8p52);
    for (int i = 0; i < Chains; ++i) {
      const Bits exponent = (Bits)((Unsigned)a.part[i] >> stored_bits) - 1023;
      e.part[i] = (Real)(exponent + (Bits)shift.part[i]) - shift.part[i];
      m.part[i] = (Real)(((Bits)a.part[i] & ((std::int64_t{1} << stored_bits) - 1)) | of_one);
    }
  }
  /// (a/b) to the power `fraction`, within 15 %, for positive a and b. The bits of a double, read as an
  /// integer, approximate its logarithm.
  friend ZEROCOUNT_ALWAYS_INLINE Simd rough_power(const Simd& a, const Simd& b, double fraction) {
    const Simd shift(0x1.8p52);
    Simd r;
    for (int i = 0; i < Chains; ++i) {
      // The upper 32 bits are enough, and are exact as a double.
      const Bits upper = ((Bits)a.part[i] >> 32) - ((Bits)b.part[i] >> 32);
      const Real logarithm = (Real)(upper + (Bits)shift.part[i]) - shift.part[i];
      constexpr double of_one = 1072693248.0;  // upper bits of 1.0
      const Real power = logarithm * fraction + of_one;
      r.part[i] = (Real)((Bits)(power + shift.part[i]) << 32);
    }
    return r;
  }
};

/// Exponential function eᵃ for a ≤ 700, to about 2e-16 relative; e⁻⁷⁰⁰ for a < −700.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P exp(const P& a) {
  const P x = max(a, P(-700.0));
  const P n = fast_rint(x * P(0x1.71547652b82fep0));  // x/ln 2
  const P r = (x - n * P(numerics::ln2_high)) - n * P(numerics::ln2_low);
  constexpr double factorials[] = {1.0 / 6227020800.0, 1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0,
                                   1.0 / 362880.0,     1.0 / 40320.0,     1.0 / 5040.0,     1.0 / 720.0,
                                   1.0 / 120.0,        1.0 / 24.0,        1.0 / 6.0,        0.5};
  P sum(factorials[0]);
  for (int i = 1; i < 12; ++i) sum = sum * r + P(factorials[i]);
  return (P(1.0) + (r + (r * r) * sum)) * exp2(n);
}

/// aⁿ for a ≥ 0 and n > 0, to about 2e-16·(1 + |n·ln a|) relative. Results from e⁷⁰⁰ on are infinite, those
/// below e⁻⁷⁰⁰ are e⁻⁷⁰⁰, except 0ⁿ = 0. NaN if a is NaN or infinite.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P pow(const P& a, const P& n) {
  constexpr double infinite = __builtin_inf();
  const P logarithm = n * numerics::logarithm_by_series(max(a, P(0x1p-1022)));
  const P power = select(logarithm < P(700.0), exp(min(logarithm, P(700.0))), P(infinite));
  return select(a == P(0.0), P(0.0), power) + (a - a);
}

}  // namespace zerocount::batch
