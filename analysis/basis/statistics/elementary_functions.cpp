// The elementary functions of <cmath> for the program's statistics, in place of those of the C library, whose
// last bit depends on the processor: results files contain confidence bounds, which Boost.Math computes by
// these names. Functions of SLEEF, as in core/numerics/elementary_functions.hpp; within 1 ulp (1.5 of erfc)
// where neither argument nor result is subnormal. sinh, cosh, asinh and acosh are infinite some way before
// their results are (above 710; above 1e200), and log1p is above 1e307.
//
// Only the program has them: no library that is installed may define functions of the C library.
#include <cmath>

#include <sleef.h>

extern "C" {

// Named to the linker, so that it takes these functions wherever the library stands among the others.
void zerocount_program_functions() noexcept {}

double exp(double x) noexcept {
  return Sleef_cinz_expd1_u10purec(x);
}
double exp2(double x) noexcept {
  return Sleef_cinz_exp2d1_u10purec(x);
}
double expm1(double x) noexcept {
  return Sleef_cinz_expm1d1_u10purec(x);
}
double log(double x) noexcept {
  return Sleef_cinz_logd1_u10purec(x);
}
double log2(double x) noexcept {
  return Sleef_cinz_log2d1_u10purec(x);
}
double log10(double x) noexcept {
  return Sleef_cinz_log10d1_u10purec(x);
}
double log1p(double x) noexcept {
  return Sleef_cinz_log1pd1_u10purec(x);
}
double pow(double x, double y) noexcept {
  return Sleef_cinz_powd1_u10purec(x, y);
}
double cbrt(double x) noexcept {
  return Sleef_cinz_cbrtd1_u10purec(x);
}
double hypot(double x, double y) noexcept {
  return Sleef_cinz_hypotd1_u05purec(x, y);
}
double sin(double x) noexcept {
  return Sleef_cinz_sind1_u10purec(x);
}
double cos(double x) noexcept {
  return Sleef_cinz_cosd1_u10purec(x);
}
double tan(double x) noexcept {
  return Sleef_cinz_tand1_u10purec(x);
}
double asin(double x) noexcept {
  return Sleef_cinz_asind1_u10purec(x);
}
double acos(double x) noexcept {
  return Sleef_cinz_acosd1_u10purec(x);
}
double atan(double x) noexcept {
  return Sleef_cinz_atand1_u10purec(x);
}
double atan2(double y, double x) noexcept {
  return Sleef_cinz_atan2d1_u10purec(y, x);
}
double sinh(double x) noexcept {
  return Sleef_cinz_sinhd1_u10purec(x);
}
double cosh(double x) noexcept {
  return Sleef_cinz_coshd1_u10purec(x);
}
double tanh(double x) noexcept {
  return Sleef_cinz_tanhd1_u10purec(x);
}
double asinh(double x) noexcept {
  return Sleef_cinz_asinhd1_u10purec(x);
}
double acosh(double x) noexcept {
  return Sleef_cinz_acoshd1_u10purec(x);
}
double atanh(double x) noexcept {
  return Sleef_cinz_atanhd1_u10purec(x);
}
double erf(double x) noexcept {
  return Sleef_cinz_erfd1_u10purec(x);
}
double erfc(double x) noexcept {
  return Sleef_cinz_erfcd1_u15purec(x);
}
double tgamma(double x) noexcept {
  return Sleef_cinz_tgammad1_u10purec(x);
}

// The compiler makes one call of the two.
void sincos(double x, double* sine, double* cosine) noexcept {
  *sine = Sleef_cinz_sind1_u10purec(x);
  *cosine = Sleef_cinz_cosd1_u10purec(x);
}
}
