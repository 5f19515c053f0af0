#pragma once

namespace zerocount::testing {

/// The elementary functions of the C library. A peer would call them in any other program; in ours the names
/// of <cmath> stand for functions that give the same bits on every processor and are slower
/// (core/numerics/elementary_functions.cpp).
struct SystemFunctions {
  double (*exp)(double);
  double (*expm1)(double);
  double (*pow)(double, double);
};

extern const SystemFunctions system_functions;

}  // namespace zerocount::testing
