#pragma once

#include <cstddef>
#include <vector>

#include "analysis/identification/test_record.hpp"

namespace zerocount {

/// A stretch over which the torque goes one way, from sample `first` to sample `last`.
struct LoadingBranch {
  std::size_t first{0};
  std::size_t last{0};
  double from{0.0};  ///< N m; 0 before the first sample
  double to{0.0};    ///< N m
};

/// A stretch over which the torque stays, from sample `first` to sample `last`.
struct TorqueHold {
  std::size_t first{0};
  std::size_t last{0};
  double torque{0.0};  ///< N m
  /// Torque shortly before (N m): where it is far from `torque`, the rotor is set swinging, and the hold
  /// begins with a ring-down.
  double from{0.0};
};

/// What a record is made of, as its torque shows it.
struct RecordParts {
  std::vector<LoadingBranch> branches;  ///< consecutive; swings of the torque below 2 % of its range are none
  std::vector<TorqueHold> holds;        ///< of 20 samples or more

  /// Number of times that the torque turns.
  std::size_t reversals() const { return branches.empty() ? 0 : branches.size() - 1; }
};

RecordParts parts_of(const TestRecord& record);

/// Whether the hold begins with a ring-down: the torque came to it by 5 % of `range` (N m) within 8 samples.
bool rings_down(const TorqueHold& hold, double range);

/// Whether the branch is slow enough to be followed without swinging: of 20 samples or more, and across at
/// least 20 % of `range` (N m).
bool is_slow(const LoadingBranch& branch, double range);

}  // namespace zerocount
