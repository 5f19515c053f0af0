#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/monitor/change_martingale.hpp"
#include "analysis/monitor/ranked_bag.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::monitor {

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
  ChangeTest(std::vector<double> baseline, const random::RandomKey& ties);
  /// @param baseline [class] values
  ChangeTest(std::vector<std::vector<double>> baseline, const random::RandomKey& ties);

  /// @param value not NaN. @returns its p-value
  double update(double value, std::size_t of_class = 0);

  const ChangeMartingale& martingale() const { return martingale_; }

 private:
  std::vector<RankedBag> bags_;  ///< [class]
  ChangeMartingale martingale_;
  random::RandomKey ties_;
  std::uint64_t history_;  ///< h
};

}  // namespace zerocount::monitor
