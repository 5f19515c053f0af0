#pragma once

#include <vector>

#include "core/trial/trial.hpp"

/// The decisions of a controller, computed independently from core/loop/equations.md and the recorded samples
/// of a whole trial at once: nothing is carried from sample to sample but where the equation itself does.
namespace zerocount::testing {

/// What the controller decides at a sample.
struct LiteralDecision {
  loop::ControlPhase phase{loop::ControlPhase::fine};
  long double integral{0};  ///< I, N m
  long double torque{0};    ///< u, N m
};

/// The decisions of a closed loop by the recorded references and counts. The last decided torque is that of
/// the record.
std::vector<LiteralDecision> literal_decisions(const trial::TrialParameters& p,
                                               const std::vector<trial::SampleRecord>& samples);

}  // namespace zerocount::testing
