#pragma once

#include "core/numerics/logarithm_by_series.hpp"
#include "core/numerics/number.hpp"

namespace zerocount::numerics {

/// Value of the polynomial c₀ + c₁·x + … + c₇·x⁷.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number polynomial_of_order_7(const double (&c)[8], const Number& x) {
  Number sum(c[7]);
  for (int i = 6; i >= 0; --i) sum = sum * x + Number(c[i]);
  return sum;
}

/// Coefficients of a rational function of order 7, numerator and denominator.
struct RationalOfOrder7 {
  double above[8];
  double below[8];
};

/// The normal quantile by algorithm AS 241 (Wichura, Applied Statistics 37 (1988) 477), PPND16: with q = p −
/// ½ and r = √(−ln min(p, 1 − p)) it is q·R(0.180625 − q²) for |q| ≤ 0.425, beyond that ±R(r − 1.6) for r ≤ 5
/// and ±R(r − 5).
inline constexpr RationalOfOrder7 normal_quantile_centre{
    {3.3871328727963666080e0, 1.3314166789178437745e+2, 1.9715909503065514427e+3, 1.3731693765509461125e+4,
     4.5921953931549871457e+4, 6.7265770927008700853e+4, 3.3430575583588128105e+4, 2.5090809287301226727e+3},
    {1.0, 4.2313330701600911252e+1, 6.8718700749205790830e+2, 5.3941960214247511077e+3,
     2.1213794301586595867e+4, 3.9307895800092710610e+4, 2.8729085735721942674e+4, 5.2264952788528545610e+3}};
inline constexpr RationalOfOrder7 normal_quantile_tail{
    {1.42343711074968357734e0, 4.63033784615654529590e0, 5.76949722146069140550e0, 3.64784832476320460504e0,
     1.27045825245236838258e0, 2.41780725177450611770e-1, 2.27238449892691845833e-2,
     7.74545014278341407640e-4},
    {1.0, 2.05319162663775882187e0, 1.67638483018380384940e0, 6.89767334985100004550e-1,
     1.48103976427480074590e-1, 1.51986665636164571966e-2, 5.47593808499534494600e-4,
     1.05075007164441684324e-9}};
inline constexpr RationalOfOrder7 normal_quantile_far_tail{
    {6.65790464350110377720e0, 5.46378491116411436990e0, 1.78482653991729133580e0, 2.96560571828504891230e-1,
     2.65321895265761230930e-2, 1.24266094738807843860e-3, 2.71155556874348757815e-5,
     2.01033439929228813265e-7},
    {1.0, 5.99832206555887937690e-1, 1.36929880922735805310e-1, 1.48753612908506148525e-2,
     7.86869131145613259100e-4, 1.84631831751005468180e-5, 1.42151175831644588870e-7,
     2.04426310338993978564e-15}};

template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number rational(const RationalOfOrder7& of, const Number& x) {
  return polynomial_of_order_7(of.above, x) / polynomial_of_order_7(of.below, x);
}

/// Quantile Φ⁻¹(p) of the standard normal distribution for p in (0, 1), within 1e-15 relative. Where 1 − p is
/// exact, its quantile is exactly the negative.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number standard_normal_quantile(const Number& p) {
  const Number q = p - Number(0.5);
  const Number from_centre = abs(q);
  const auto central = from_centre <= Number(0.425);
  Number tail(0.0);
  if (any(from_centre > Number(0.425))) {
    const Number r = sqrt(-logarithm_by_series(min(p, Number(1.0) - p)));
    const auto far = r > Number(5.0);
    tail = rational(normal_quantile_tail, r - Number(1.6));
    if (any(far)) tail = select(far, rational(normal_quantile_far_tail, r - Number(5.0)), tail);
    tail = select(q < Number(0.0), -tail, tail);
  }
  return select(central, q * rational(normal_quantile_centre, Number(0.180625) - q * q), tail);
}

}  // namespace zerocount::numerics
