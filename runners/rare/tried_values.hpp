#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "runners/rare/proposal.hpp"
#include "runners/rare/trial_point.hpp"

namespace zerocount::rare {

/// A value of a discrete draw, and what its last trials showed.
struct TriedValue {
  PinnedValue value;
  std::vector<double> scores;  ///< [score] the largest; −∞: not known

  void take(std::span<const PointResult> results);
};

/// At most `count` values: those with most failures, and by turns those with the largest value of each score.
std::vector<TriedValue> most_suspicious(const std::vector<TriedValue>& tried, std::size_t count,
                                        std::size_t scores);

}  // namespace zerocount::rare
