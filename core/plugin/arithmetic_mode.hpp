#pragma once

#include <xmmintrin.h>

namespace zerocount::plugin {

/// The mode of floating-point arithmetic (rounding, denormal numbers, masks) of this thread. Libraries
/// compiled with -ffast-math, or code that sets it, would change all that is computed after them.
class ArithmeticMode {
 public:
  /// The mode in force.
  ArithmeticMode() : mode_(_mm_getcsr()) {}

  /// Sets the mode back to it. The flags of exceptions that have occurred stay as they are.
  void restore() const {
    constexpr unsigned flags = 0x3f;
    if (((_mm_getcsr() ^ mode_) & ~flags) != 0) _mm_setcsr(mode_);
  }

 private:
  unsigned mode_;
};

}  // namespace zerocount::plugin
