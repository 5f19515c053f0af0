#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "experiments/study/grouping.hpp"

namespace zerocount::study {

using SquareMatrix = std::vector<std::vector<double>>;  ///< [row][column]

/// A Gaussian copula: the normal scores zᵢ = Φ⁻¹(uᵢ) of the values of some slots are correlated by R, and the
/// distribution of each value stays its own (Nelsen, An Introduction to Copulas, 2nd ed., 2006, section 2.3).
struct GaussianCopula {
  std::vector<std::uint32_t> slots;   ///< in the order of columns
  DrawLevel level{DrawLevel::trial};  ///< how often all of them are drawn: world, rig or trial
  SquareMatrix factor;                ///< L, lower triangular, R = L·Lᵀ
};

/// L of the correlation matrix R; nothing if R is not positive definite.
std::optional<SquareMatrix> cholesky_factor(const SquareMatrix& correlations);

/// The uniform number of member `member`: Φ(Σⱼ L(member, j)·Φ⁻¹(uⱼ)). The first member keeps its own, and so
/// does every member that no earlier one is correlated with.
/// @param independent uⱼ in (0, 1) of member j
double copula_uniform(const GaussianCopula& copula, std::size_t member,
                      const std::function<double(std::size_t)>& independent);

}  // namespace zerocount::study
