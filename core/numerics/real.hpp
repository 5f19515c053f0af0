#pragma once

#include <cmath>
#include <limits>
#include <ostream>
#include <type_traits>

#include <boost/operators.hpp>

#include "core/numerics/elementary_functions.hpp"

namespace zerocount::numerics {

/// A floating-point type around double for Boost.Math. Boost calls exp(x), log(x) … unqualified, so that for
/// this type it finds the project's functions, whose results have the same bits on every processor
/// (https://www.boost.org/doc/libs/1_74_0/libs/math/doc/html/math_toolkit/real_concepts.html).
class Real : boost::ordered_field_operators<Real> {
 public:
  Real() = default;
  template <class Number>
  requires std::is_arithmetic_v<Number>
  constexpr Real(Number value) : value_(static_cast<double>(value)) {}  // NOLINT(google-explicit-constructor)

  constexpr explicit operator double() const { return value_; }
  constexpr explicit operator int() const { return static_cast<int>(value_); }

  constexpr Real operator-() const { return -value_; }
  constexpr Real& operator+=(Real b) { return *this = value_ + b.value_; }
  constexpr Real& operator-=(Real b) { return *this = value_ - b.value_; }
  constexpr Real& operator*=(Real b) { return *this = value_ * b.value_; }
  constexpr Real& operator/=(Real b) { return *this = value_ / b.value_; }
  friend constexpr bool operator==(Real a, Real b) { return a.value_ == b.value_; }
  friend constexpr bool operator<(Real a, Real b) { return a.value_ < b.value_; }
  friend std::ostream& operator<<(std::ostream& stream, Real a) { return stream << a.value_; }

  friend Real exp(Real x) { return numerics::exp_of_draws(x.value_); }
  friend Real log(Real x) { return numerics::log_of_draws(x.value_); }
  friend Real pow(Real x, Real y) { return numerics::pow_of_draws(x.value_, y.value_); }
  friend Real sin(Real x) { return numerics::sin(x.value_); }
  friend Real asin(Real x) { return numerics::asin(x.value_); }

  // Exact, or rounded correctly by all processors.
  friend Real sqrt(Real x) { return std::sqrt(x.value_); }
  friend Real abs(Real x) { return std::abs(x.value_); }
  friend Real fabs(Real x) { return std::abs(x.value_); }
  friend Real floor(Real x) { return std::floor(x.value_); }
  friend Real ceil(Real x) { return std::ceil(x.value_); }
  friend Real ldexp(Real x, int exponent) { return std::ldexp(x.value_, exponent); }
  friend Real frexp(Real x, int* exponent) { return std::frexp(x.value_, exponent); }

 private:
  double value_;
};

}  // namespace zerocount::numerics

template <>
class std::numeric_limits<zerocount::numerics::Real> : public std::numeric_limits<double> {
  using Real = zerocount::numerics::Real;
  using Double = std::numeric_limits<double>;

 public:
  static constexpr Real min() { return Double::min(); }
  static constexpr Real max() { return Double::max(); }
  static constexpr Real lowest() { return Double::lowest(); }
  static constexpr Real epsilon() { return Double::epsilon(); }
  static constexpr Real denorm_min() { return Double::denorm_min(); }
  static constexpr Real infinity() { return Double::infinity(); }
  static constexpr Real quiet_NaN() { return Double::quiet_NaN(); }
};
