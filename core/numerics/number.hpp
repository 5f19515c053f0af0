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

/// a where `mask`, else b.
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
/// −1, 0 or 1.
ZEROCOUNT_ALWAYS_INLINE double sign(double a) {
  return a > 0.0 ? 1.0 : (a < 0.0 ? -1.0 : 0.0);
}
/// The nearest whole number, half to even in the default rounding mode.
ZEROCOUNT_ALWAYS_INLINE double rint(double a) {
  return __builtin_nearbyint(a);
}
ZEROCOUNT_ALWAYS_INLINE double floor(double a) {
  return __builtin_floor(a);
}

}  // namespace zerocount
