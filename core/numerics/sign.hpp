#pragma once

namespace zerocount {

/// −1, 0 or 1.
inline int sign_of(double value) {
  return (value > 0.0) - (value < 0.0);
}

}  // namespace zerocount
