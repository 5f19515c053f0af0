#pragma once

#include <cstddef>
#include <vector>

#include "analysis/identification/test_record.hpp"

namespace zerocount::identification {

/// A part with a monotonic torque, from sample `first` to sample `last`.
struct LoadingBranch {
  std::size_t first{0};
  std::size_t last{0};
  double from{0.0};  ///< N m; 0 before the first sample
  double to{0.0};    ///< N m
};

/// A part with a constant torque, from sample `first` to sample `last`.
struct TorqueHold {
  std::size_t first{0};
  std::size_t last{0};
  double torque{0.0};  ///< N m
  /// Torque shortly before the hold, N m. If it differs much from `torque`, the hold begins with a ring-down.
  double from{0.0};
};

/// The parts of a record, found from its torque.
struct RecordParts {
  std::vector<LoadingBranch> branches;  ///< consecutive; torque reversals below 2 % of the range are ignored
  std::vector<TorqueHold> holds;        ///< of 20 samples or more

  /// Number of torque reversals.
  std::size_t reversals() const { return branches.empty() ? 0 : branches.size() - 1; }
};

RecordParts parts_of(const TestRecord& record);

/// Whether the hold begins with a ring-down: the torque changed by 5 % of `range` (N m) within 8 samples.
bool rings_down(const TorqueHold& hold, double range);

/// Whether the rotor follows the branch without oscillation: it has at least 20 samples and covers at least
/// 20 % of `range` (N m).
bool is_slow(const LoadingBranch& branch, double range);

}  // namespace zerocount::identification
