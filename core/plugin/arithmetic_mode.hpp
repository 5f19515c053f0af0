#pragma once

#include <xmmintrin.h>

namespace zerocount::plugin {

/// The mode of floating-point arithmetic (rounding, denormal numbers, masks) of this thread. A library
/// compiled with -ffast-math, or code that sets the mode, would change everything computed after it.
class ArithmeticMode {
 public:
  /// Saves the present mode.
  ArithmeticMode() : mode_(_mm_getcsr()) {}

  /// Restores the saved mode, except the flags of exceptions that have occurred.
  void restore() const {
    constexpr unsigned flags = 0x3f;
    if (((_mm_getcsr() ^ mode_) & ~flags) != 0) _mm_setcsr(mode_);
  }

 private:
  unsigned mode_;
};

}  // namespace zerocount::plugin
