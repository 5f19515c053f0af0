#pragma once

/// Elementary functions whose results have the same bits on every processor. glibc chooses its exp, log, sin
/// … by the processor (with or without fused operations, for one), and the last bit of a result may differ.
/// Code that draws parameters or computes a trial therefore calls these functions in place of those of
/// <cmath>.
///
/// They use no fused operations, and are accurate within 1 ulp where neither argument nor result is
/// subnormal. exp, expm1, log and pow, which a trial calls most, are table-driven: 2 to 8 times as fast as
/// SLEEF's. sine_and_cosine is our own, too; the others are SLEEF's. log1p is infinite above 1e307.
namespace zerocount::numerics {

double exp(double x) noexcept;
double expm1(double x) noexcept;
double log(double x) noexcept;
/// Exponential function of the SLEEF library. Quantities that differ between trials are drawn with SLEEF's
/// functions, so that a manifest (study input file) keeps its draws.
double exp_of_draws(double x) noexcept;
double expm1_of_draws(double x) noexcept;
double log_of_draws(double x) noexcept;
double pow_of_draws(double x, double y) noexcept;
double log1p(double x) noexcept;
double pow(double x, double y) noexcept;
double cbrt(double x) noexcept;
double hypot(double x, double y) noexcept;
double sin(double x) noexcept;
double cos(double x) noexcept;
double tan(double x) noexcept;
double asin(double x) noexcept;

struct SineAndCosine {
  double sine;
  double cosine;
};
/// The sine and the cosine of x (rad), in less time than sin(x) alone.
SineAndCosine sine_and_cosine(double x) noexcept;

}  // namespace zerocount::numerics
