#pragma once

#include "experiments/distributions/distribution.hpp"

namespace zerocount::distributions {

/// The numbers of a quantile function that do not depend on the probability.
struct QuantileConstants {
  double low{0.0};       ///< log-uniform: ln low; log-normal: ln median; truncated: P(Z ≤ lower limit)
  double high{0.0};      ///< log-uniform: ln high; log-normal: s; truncated: P(Z ≤ upper limit)
  bool mirrored{false};  ///< truncated: an upper tail, whose probabilities would be differences near 1
};

/// The quantile function of one distribution, for many draws: bitwise equal to quantile().
class QuantileFunction {
 public:
  explicit QuantileFunction(const Distribution& distribution);
  double operator()(double u) const;

 private:
  Distribution distribution_;
  QuantileConstants constants_;
};

}  // namespace zerocount::distributions
