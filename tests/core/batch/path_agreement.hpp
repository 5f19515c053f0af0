#pragma once

#include <string>

#include "tests/core/batch/batched_trials.hpp"

namespace zerocount::testing {

/// How a trial of the batch engine follows the reference, where no hook divides it into parts before and
/// after a slide.
struct PathAgreement {
  bool parts{false};      ///< a count or a code differs from some sample on; what follows is not compared
  bool amplifies{false};  ///< the reference parts from itself first, if it is changed; likewise
  std::string
      astray{};  ///< where θ differs by more than rounding explains, and by how much; empty if nowhere
};

/// θ agrees to 1e-6 count and 1e-9 of the travel, or to what a change of the inertia by 1e-12 makes of the
/// reference: a limit cycle may amplify rounding to any size. Where that change has changed a count or a code
/// before, no agreement can be asked for.
PathAgreement path_agreement(const trial::TrialParameters& parameters, const BatchedTrial& batched,
                             const BatchedTrial& reference);

}  // namespace zerocount::testing
