#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace zerocount::monitor {

enum class Direction { higher, lower };

/// The capital of a gambler who bets that a sequence of values changed at some time to higher or lower ones.
///
/// The value number t after n values of a baseline has the p-value
///
///     p_t = (a + u·(e + 1)) / (n + t)
///
/// of the `a` larger and `e` equal ones among the n + t − 1 values before it, u uniform in (0, 1). If all
/// n + t values are exchangeable, p_1, p_2, … are independent and uniform (the smoothed conformal
/// p-values of Vovk, Gammerman and Shafer, Algorithmic Learning in a Random World), however the values are
/// distributed.
///
///     capital_t = r_t + Σ_b Σ_k W_{b,k}(t),          r_t = 1/log2(t + 2)
///     W_{b,k}(t) = (W_{b,k}(t − 1) + stake_{b,k}(t)) · b(p_t; 2^k/(n + t − 1))
///
/// Each bet b(p; κ) has the mean 1 over uniform p. What r loses at t is staked in equal parts on changes at t
/// of six sizes, κ = 2^k/(n + t − 1) between 1/32 and 2. So the capital is a martingale that begins at 1, and
/// the probability that it ever reaches 1/α is at most α (Ville). The size of a bet falls as n + t − 1 grows,
/// because the values after a change become part of what later ones are ranked among.
///
/// The bets, of both directions alike. Half of each stake: exp(κz − κ²/2) with z = Φ⁻¹(1 − p). The other half
/// in equal parts on steps at the proportions q: 1 + κ·(1 − q)/√(q(1 − q)) for p < q, otherwise
/// 1 − κ·q/√(q(1 − q)), κ at most 0.9 of what keeps it positive. Bets on lower values have 1 − p for p.
class ChangeMartingale {
 public:
  /// @param baseline its number of values n, at least 1
  explicit ChangeMartingale(std::int64_t baseline);

  /// @param p in (0, 1)
  void update(double p);

  std::int64_t values() const { return values_; }  ///< t
  double capital() const;
  /// The direction on which the capital depends most.
  Direction direction() const;
  /// The most likely time of the change in that direction, from 1, by the bet that gained most.
  /// @param p all p-values until now
  std::int64_t since(std::span<const double> p) const;

 private:
  static constexpr std::size_t max_sizes = 64;
  static constexpr std::size_t kinds = 12;  ///< of bets: by normal scores, and one by each step
  using Capitals = std::array<double, max_sizes>;

  std::int64_t baseline_;
  std::int64_t values_{0};
  int lowest_;                                             ///< k of sizes [0]
  std::size_t sizes_;                                      ///< in use
  std::array<std::array<Capitals, kinds>, 2> capitals_{};  ///< [direction][kind][size]
};

}  // namespace zerocount::monitor
