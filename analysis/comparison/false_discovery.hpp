#pragma once

#include <span>
#include <vector>

namespace zerocount::comparison {

/// Adjusted p-values that control the false discovery rate whatever the dependence between the tests: with
/// p_(1) ≤ … ≤ p_(m) and H_m = 1 + 1/2 + … + 1/m,
///
///   q_(i) = min over j ≥ i of min(1, m·H_m·p_(j)/j).
///
/// Rejecting where q ≤ α has an expected proportion of false rejections of at most α. Where every null
/// hypothesis is true, that is the probability of any rejection at all. Source: Benjamini and Yekutieli,
/// Annals of Statistics 29 (2001), 1165, Theorem 1.3.
///
/// @param p in [0, 1], any order; @return in the same order.
std::vector<double> benjamini_yekutieli(std::span<const double> p);

}  // namespace zerocount::comparison
