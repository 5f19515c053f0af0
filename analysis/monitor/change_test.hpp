#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/monitor/change_martingale.hpp"
#include "analysis/monitor/ranked_bag.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::monitor {

/// The values of one measure, one after the other, tested for a change since their baseline: p-values among
/// all earlier values, on which a ChangeMartingale bets.
class ChangeTest {
 public:
  /// @param ties stream of the numbers u of ChangeMartingale: that of the value number t has the index t
  ChangeTest(std::vector<double> baseline, const random::RandomStream& ties);

  /// @param value not NaN. @returns its p-value
  double update(double value);

  const ChangeMartingale& martingale() const { return martingale_; }

 private:
  RankedBag bag_;
  ChangeMartingale martingale_;
  random::RandomStream ties_;
};

}  // namespace zerocount::monitor
