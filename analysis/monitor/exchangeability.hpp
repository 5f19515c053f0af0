#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/random/random_numbers.hpp"

namespace zerocount::monitor {

/// Evidence in the order of values against their exchangeability.
struct Dependence {
  double p{1.0};         ///< probability of as much dependence in a random order
  std::int64_t over{0};  ///< consecutive values that resemble each other most clearly
  bool alternates{
      false};  ///< consecutive values differ more than in a random order: `over` of them average out
};

/// Tests whether values are exchangeable within their classes, with power against what lasts long but weakly,
/// such as days that differ a little.
///
/// Each value counts by its rank within its class, centred. For b = 2, 4, 8, … up to a third of the n values
///
///     T_b = Σ_i (x_i + … + x_{i+b−1})²   over all i,
///
/// which is large if neighbours within b values resemble each other, and small if they alternate. The
/// statistic is the largest |z_b| of T_b, z_b by its mean and standard deviation over random orders of
/// the values of each class; p is its rank among those of the random orders. So p is valid for any
/// distribution. The first 100 000 values are tested; fewer than eight are not.
/// @param classes [value]
Dependence dependence_of(std::span<const double> values, std::span<const std::size_t> classes,
                         const random::RandomKey& key);

/// [value] its rank within its class, as a part of the class in (0, 1); equal values have the same.
std::vector<double> ranks_within(std::span<const double> values, std::span<const std::size_t> classes);

/// The part of the variance of the ranks of all values that lies between the classes. Two equal normal
/// classes have two peaks from a distance of 2σ on, where it is one half.
double part_between(std::span<const double> values, std::span<const std::size_t> classes);

}  // namespace zerocount::monitor
