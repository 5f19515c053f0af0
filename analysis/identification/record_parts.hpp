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
  /// Whether the rotor follows without oscillation: 20 samples or more, over at least 20 % of the range.
  bool slow{false};
};

/// A part with a constant torque, from sample `first` to sample `last`.
struct TorqueHold {
  std::size_t first{0};
  std::size_t last{0};
  double torque{0.0};      ///< N m
  double from{0.0};        ///< torque 8 samples before the hold, N m
  bool rings_down{false};  ///< begins with a ring-down: the torque changed by 5 % of the range since `from`
};

/// The parts of a record, found from its torque. Percentages are of the range of the torque.
struct RecordParts {
  std::vector<LoadingBranch> branches;  ///< consecutive; torque reversals below 2 % of the range are ignored
  std::vector<TorqueHold> holds;        ///< of 20 samples or more

  /// Number of torque reversals.
  std::size_t reversals() const { return branches.empty() ? 0 : branches.size() - 1; }

  /// Number of holds that begin with a ring-down.
  std::size_t ring_downs() const;
};

RecordParts parts_of(const TestRecord& record);

}  // namespace zerocount::identification
