#pragma once

#ifdef __aarch64__
#include <cstdint>
#else
#include <xmmintrin.h>
#endif

namespace zerocount::plugin {

#ifdef __aarch64__
/// Reads the Arm register FPCR, the mode of floating-point arithmetic (Arm Architecture Reference Manual,
/// C5.2.8). The flags of exceptions are in another register.
inline std::uint64_t arithmetic_control() {
  std::uint64_t bits = 0;
  asm volatile("mrs %0, fpcr" : "=r"(bits));
  return bits;
}
inline void set_arithmetic_control(std::uint64_t bits) {
  asm volatile("msr fpcr, %0" : : "r"(bits));
}
#else
/// Reads the x86 register MXCSR, the mode of floating-point arithmetic, without the flags of exceptions that
/// have occurred.
inline unsigned arithmetic_control() {
  constexpr unsigned flags = 0x3f;
  return _mm_getcsr() & ~flags;
}
inline void set_arithmetic_control(unsigned bits) {
  _mm_setcsr(bits);
}
#endif

/// The mode of floating-point arithmetic (rounding, denormal numbers, masks) of this thread. A library
/// compiled with -ffast-math, or code that sets the mode, would change everything computed after it.
class ArithmeticMode {
 public:
  /// Saves the present mode of floating-point arithmetic.
  ArithmeticMode() : mode_(arithmetic_control()) {}

  /// Restores the saved mode of floating-point arithmetic.
  void restore() const {
    if (arithmetic_control() != mode_) set_arithmetic_control(mode_);
  }

 private:
  decltype(arithmetic_control()) mode_;
};

}  // namespace zerocount::plugin
