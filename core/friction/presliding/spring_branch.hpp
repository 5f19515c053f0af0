#pragma once

#include "core/numerics/number.hpp"

namespace zerocount::friction {

/// One branch of the spring's hysteresis (paper, eq. 1):
///
///   σ(x) = σr + s·[k1·|x − xr| + (softening_torque)·(1 − exp(−softening_rate·|x − xr|))],   s = sgn(x − xr).
///
/// An ordinary branch starts at the last reversal point with softening_rate = β and softening_torque = k2/β.
/// The virgin curve σ(x) = sgn(x)·½·f(2|x|) is the same law from the origin with 2β and k2/(2β).
/// @tparam Number double, or a vector of the batch engine.
template <class Number>
struct SpringBranchOf {
  Number elongation{0.0};        ///< xr, where the branch starts, rad
  Number torque{0.0};            ///< σr, N m
  Number sign{1.0};              ///< s, the side of xr on which the branch lies
  Number k1{0.0};                ///< N m/rad
  Number softening_torque{0.0};  ///< N m
  Number softening_rate{0.0};    ///< 1/rad
};

/// |x − xr| at the elongation x (rad).
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number travel_on(const SpringBranchOf<Number>& branch, const Number& x) {
  return branch.sign * (x - branch.elongation);
}

/// σ (N m) after the travel |x − xr| (rad), with softened = 1 − exp(−softening_rate·|x − xr|).
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number torque_after(const SpringBranchOf<Number>& branch, const Number& travel,
                                            const Number& softened) {
  return branch.torque + branch.sign * (branch.k1 * travel + branch.softening_torque * softened);
}

}  // namespace zerocount::friction
