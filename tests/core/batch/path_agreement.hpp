#pragma once

#include <string>

#include "tests/core/batch/batched_trials.hpp"

namespace zerocount::testing {

/// How a trial of the batch engine follows the reference, where no hook divides it into parts before and
/// after a slide.
struct PathAgreement {
  bool parts{false};   ///< a count or a code differs from some sample on; what follows is not compared
  std::string astray;  ///< where θ differs by more than rounding explains, and by how much; empty if nowhere
};

/// θ agrees to 1e-6 count and 1e-9 of the travel, or to what a change of inertia and breakaway torque by
/// 2e-12 makes of the reference: a limit cycle may amplify rounding to any size.
PathAgreement path_agreement(const trial::TrialParameters& parameters, const BatchedTrial& batched,
                             const BatchedTrial& reference);

}  // namespace zerocount::testing
