#pragma once

/// Formulas for double and for the vectors of the batch engine (core/batch/kernels/simd.hpp) are templates
/// over the number type. They use these functions; those of a vector type are found by its namespace.
/// Comparisons give a mask, bool or the vector's, with & and |.
///
/// The kernels are compiled once for each instruction set. The headers that they include contain only
/// templates over the number type, and include no others: of an inline function of double the linker could
/// keep a copy compiled for an instruction set that the processor lacks.
namespace zerocount {

#define ZEROCOUNT_ALWAYS_INLINE __attribute__((always_inline)) inline

/// Whether the mask is set; for a vector's mask, whether it is set in any lane.
ZEROCOUNT_ALWAYS_INLINE bool any(bool mask) {
  return mask;
}
ZEROCOUNT_ALWAYS_INLINE bool negated(bool mask) {
  return !mask;
}
/// Returns a if `mask` is set, otherwise b.
ZEROCOUNT_ALWAYS_INLINE double select(bool mask, double a, double b) {
  return mask ? a : b;
}
ZEROCOUNT_ALWAYS_INLINE double abs(double a) {
  return __builtin_fabs(a);
}
ZEROCOUNT_ALWAYS_INLINE double min(double a, double b) {
  return b < a ? b : a;
}
ZEROCOUNT_ALWAYS_INLINE double max(double a, double b) {
  return a < b ? b : a;
}
ZEROCOUNT_ALWAYS_INLINE double sqrt(double a) {
  return __builtin_sqrt(a);
}
/// Quotient a/b for a divisor b that stays the same in a loop; for vectors it is a·(1/b), so that the
/// reciprocal is computed once.
ZEROCOUNT_ALWAYS_INLINE double by_fixed(double a, double b) {
  return a / b;
}
/// Sign of a: −1, 0 or 1.
ZEROCOUNT_ALWAYS_INLINE double sign(double a) {
  return a > 0.0 ? 1.0 : (a < 0.0 ? -1.0 : 0.0);
}
/// Rounds a to the nearest whole number, half to even in the default rounding mode.
ZEROCOUNT_ALWAYS_INLINE double rint(double a) {
  return __builtin_nearbyint(a);
}
ZEROCOUNT_ALWAYS_INLINE double floor(double a) {
  return __builtin_floor(a);
}
/// Splits a normal number a > 0 into the factors of a = m·2ᵉ with 1 ≤ m < 2.
ZEROCOUNT_ALWAYS_INLINE void split(double a, double& m, double& e) {
  constexpr int stored_bits = 52;
  constexpr long long of_one = 1023LL << stored_bits;  // bits of 1.0
  long long bits;
  static_assert(sizeof bits == sizeof a);
  __builtin_memcpy(&bits, &a, sizeof bits);
  e = static_cast<double>((bits >> stored_bits) - 1023);
  bits = (bits & ((1LL << stored_bits) - 1)) | of_one;
  __builtin_memcpy(&m, &bits, sizeof m);
}

}  // namespace zerocount
