#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/numerics/interval.hpp"

namespace zerocount::distributions {

// The distributions of a manifest. Parameters have the unit of the quantity. All distributions are sampled by
// their quantile function, so that all designs map uniform numbers in the same way.

/// Uniform distribution on the half-open interval [low, high).
struct Uniform {
  double low{0.0};
  double high{1.0};
  bool operator==(const Uniform&) const = default;
};

/// Log-uniform distribution: the logarithm is uniform, so the density is ∝ 1/x on [low, high), 0 < low.
struct LogUniform {
  double low{1.0};
  double high{2.0};
  bool operator==(const LogUniform&) const = default;
};

/// Gaussian with the given mean and standard deviation.
struct Normal {
  double mean{0.0};
  double sd{1.0};
  bool operator==(const Normal&) const = default;
};

/// Truncated normal distribution: a Gaussian with the mean `mean` and the standard deviation `sd` (before
/// truncation), restricted to values in [low, high).
struct TruncatedNormal {
  double mean{0.0};
  double sd{1.0};
  double low{-1.0};
  double high{1.0};
  bool operator==(const TruncatedNormal&) const = default;
};

/// Distribution whose logarithm is Gaussian, with the standard deviation s. It is given by its median exp(μ)
/// and its coefficient of variation (standard deviation over mean of the variable itself) cv = √(exp(s²) −
/// 1), so s = √ln(1 + cv²).
struct Lognormal {
  double median{1.0};
  double cv{0.1};
  bool operator==(const Lognormal&) const = default;
};

/// Triangular distribution: the density rises linearly from `low` to `mode` and falls linearly to `high`.
struct Triangular {
  double low{0.0};
  double mode{0.5};
  double high{1.0};
  bool operator==(const Triangular&) const = default;
};

/// Uniform distribution on the whole numbers `low` … `high`, each multiplied by `unit`.
struct Integers {
  std::int64_t low{0};
  std::int64_t high{1};
  double unit{1.0};  ///< factor, above 0; differs from 1 only after scaled()
  bool operator==(const Integers&) const = default;
};

/// A discrete distribution: all listed values are equally likely.
struct Choice {
  std::vector<double> values;
  bool operator==(const Choice&) const = default;
};

using Distribution =
    std::variant<Uniform, LogUniform, Normal, TruncatedNormal, Lognormal, Triangular, Integers, Choice>;

/// The interval of the values that the distribution can give.
numerics::Interval support(const Distribution& distribution);

/// The value that the uniform number u, 0 < u < 1, gives for a random quantity with this distribution, in the
/// quantity's unit. For a continuous distribution it is the quantile: P(X ≤ x) = u. For a discrete
/// distribution of n values it is the value with index ⌊n·u⌋. The values of a Choice are in the order of its
/// list, which may not be sorted.
double quantile(const Distribution& distribution, double u);

/// A uniform number whose quantile is x, to rounding; empty if x cannot be drawn. For a continuous
/// distribution it is P(X ≤ x); for a discrete distribution the middle of the interval that gives x.
std::optional<double> uniform_of(const Distribution& distribution, double x);

/// The distribution of `factor` times the quantity.
/// @param factor above 0
Distribution scaled(const Distribution& distribution, double factor);

/// The distribution of a quantity that lies `factor` times as far from its centre. The centre is the mean of
/// a Gaussian, the mode of a triangle, or the middle of an interval. Logarithmic distributions are widened in
/// the logarithm, so positive values stay positive. Whole numbers and choices are not changed.
/// @param factor above 0
Distribution widened(const Distribution& distribution, double factor);

/// Whether the lowest and the highest value that quantile() can return for the distribution are in `range`.
/// These values may overflow for very large parameters.
bool extremes_are_inside(const Distribution& distribution, const numerics::Interval& range);

/// Whether all values that the distribution can give are whole numbers.
bool whole_numbers_only(const Distribution& distribution);

/// Message about invalid parameters of a distribution, in two phrases.
struct DistributionFault {
  std::string what;
  std::string expected;
};

/// The first fault of a distribution with finite parameters: low not below high, no spread, an empty choice,
/// …
std::optional<DistributionFault> find_fault(const Distribution& distribution);

/// Constants of the quantile function of one distribution: its terms that do not depend on the probability,
/// computed once for many draws.
struct QuantileConstants {
  double low{0.0};   ///< log-uniform: ln low; log-normal: ln median; truncated: P(Z ≤ lower limit)
  double high{0.0};  ///< log-uniform: ln high; log-normal: s; truncated: P(Z ≤ upper limit)
  /// For a truncated normal distribution: the range is an upper tail, whose probabilities would be
  /// differences of numbers near 1, so the mirrored lower tail is used.
  bool mirrored{false};
};

/// The quantile function of one distribution with its constants computed once, for many draws. Its values are
/// bitwise equal to those of quantile().
class QuantileFunction {
 public:
  explicit QuantileFunction(const Distribution& distribution);
  double operator()(double u) const;

 private:
  Distribution distribution_;
  QuantileConstants constants_;
};

}  // namespace zerocount::distributions
