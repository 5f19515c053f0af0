#pragma once

#include "experiments/study.hpp"

namespace zerocount {

/// What a study uses of the loop, as far as its table has columns for it that others need not.
struct StudyFeatures {
  bool open_loop{false};       ///< torque levels in place of targets
  bool travel{false};          ///< at some point, the reference takes its time
  bool phases{false};          ///< at some point, the control has two phases
  bool encoder_errors{false};  ///< at some point, an encoder is not ideal
  /// At some point moves may end beside their targets by design: no integral control, friction without
  /// pre-sliding motion, or moves that are long.
  bool final_error{false};
};

/// What a trial with these parameters uses of the loop.
StudyFeatures trial_features(const TrialParameters& parameters);

/// What the first trials of the points use, and what the study says of its sample records.
StudyFeatures study_features(const Study& study);

}  // namespace zerocount
