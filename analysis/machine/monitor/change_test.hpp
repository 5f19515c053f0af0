#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/random/random_numbers.hpp"

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
  /// @param baseline number n of values in the baseline, at least 1
  explicit ChangeMartingale(std::int64_t baseline);

  /// Adds the next value.
  /// @param p p-value of this value: its rank, as a proportion, among all values before it and the baseline,
  /// in (0, 1); small for a large value
  void update(double p);

  std::int64_t values() const { return values_; }  ///< Number t of values so far, without the baseline.
  double capital() const;
  /// Direction (higher or lower values) on whose bets most of the capital rests at present.
  Direction direction() const;
  /// Estimated number of the first value after the change, from 1 for the first value after the baseline. It
  /// comes from the bet in direction() that gained most.
  /// @param p p-values of all values until now, in their order
  std::int64_t since(std::span<const double> p) const;

 private:
  static constexpr std::size_t max_sizes = 64;
  /// Number of kinds of bets: one by normal scores, and one for each step.
  static constexpr std::size_t kinds = 12;
  using Capitals = std::array<double, max_sizes>;

  std::int64_t baseline_;
  std::int64_t values_{0};
  /// Smallest exponent k of the bet sizes 2^k/(number of values so far); index 0 of a kind's capitals.
  int lowest_;
  std::size_t sizes_;  ///< Number of bet sizes 2^k/(number of values so far) in use.
  /// [direction][kind of bet][size] Capital of the bets.
  std::array<std::array<Capitals, kinds>, 2> capitals_{};
};

/// A growing multiset of values, none of them NaN, in which new values are ranked. Insertion takes amortised
/// logarithmic time: the values lie in sorted runs, each at least twice as long as the next.
class RankedBag {
 public:
  explicit RankedBag(std::vector<double> values);

  struct Place {
    std::int64_t above{0};  ///< Number of values in the bag that are larger than the new value.
    std::int64_t equal{0};
  };
  Place place_of(double value) const;
  void insert(double value);
  std::int64_t size() const { return size_; }

 private:
  std::vector<std::vector<double>> runs_;
  std::int64_t size_{0};
};

/// The values of one measure, one after the other, tested for a change since their baseline: p-values among
/// all earlier values of the same class, on which a ChangeMartingale bets.
///
/// If the values of each class are exchangeable, whatever the classes have to do with each other and in
/// whatever order they come, the p-values are independent and uniform (Mondrian conformal prediction): given
/// the multiset of values of each class until now and all later ones, each value of the class of the last one
/// is as likely as any other to be the last. So one martingale bets on all classes.
///
/// The number u of a value (ChangeMartingale) is a random function of the ranks of the moves before it, so
/// that sequences that differ have different numbers, and what does not change the ranks changes nothing:
///
///     h_0 = n,   u_t = open_uniform(w(0, h_{t−1})),   h_t = w(1, h_{t−1} ⊕ (a_t + 2³²·e_t)),
///
/// w(s, i) the random bits of the key with the stream s and the index i.
class ChangeTest {
 public:
  /// @param baseline [class of similar moves] values of the measure before the log begins
  /// @param ties random key for the numbers that break ties
  ChangeTest(std::vector<std::vector<double>> baseline, const random::RandomKey& ties);

  /// @param value next value of the measure, not NaN
  /// @param of_class index of the class of similar moves to which it belongs
  /// @returns its p-value: the smoothed proportion of values of its class, itself included, that are larger
  double update(double value, std::size_t of_class = 0);

  const ChangeMartingale& martingale() const { return martingale_; }

 private:
  std::vector<RankedBag> bags_;  ///< [class of values] Sorted values so far, including the baseline.
  ChangeMartingale martingale_;
  random::RandomKey ties_;
  /// State h of the generator of the numbers u that break ties; it depends on the ranks so far.
  std::uint64_t history_;
};

/// Evidence in the order of values against their exchangeability.
struct Dependence {
  double p{1.0};  ///< Probability that a random order of the values shows at least as much dependence.
  /// Number of consecutive values (window length) at which the dependence is clearest; 0 if not tested.
  std::int64_t over{0};
  /// True if consecutive values differ more than in a random order, so that `over` of them average out.
  bool alternates{false};
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
/// @param classes [value] index of the class to which each value belongs
Dependence dependence_of(std::span<const double> values, std::span<const std::size_t> classes,
                         const random::RandomKey& key);

/// Number of sorted values below `value`, plus half the number of values equal to it.
double mid_rank(std::span<const double> sorted, double value);

/// [value] Rank of each value within its class, as a proportion in (0, 1). Equal values have equal ranks.
std::vector<double> ranks_within(std::span<const double> values, std::span<const std::size_t> classes);

/// Proportion of the variance of the ranks of all values that is due to differences between the classes, in
/// [0, 1]. For example, two classes of equal size with normal values of the same standard deviation σ give
/// one half when their means are 2σ apart; from there on their joint distribution has two peaks.
/// @param classes [value] index of the class to which each value belongs
double part_between(std::span<const double> values, std::span<const std::size_t> classes);

}  // namespace zerocount::monitor
