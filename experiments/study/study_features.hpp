#pragma once

#include "experiments/study/study.hpp"

namespace zerocount::study {

/// What a study uses of the loop, as far as its table has columns for it that others need not. It is decided
/// by what the parameters can be in any trial, so that studies which differ in their seed have the same
/// columns.
struct StudyFeatures {
  parameters::AxisKind axis{parameters::AxisKind::rotary};  ///< whose units the tables have
  bool open_loop{false};                                    ///< torque levels in place of targets
  bool travel{false};                                       ///< at some point, the reference takes its time
  bool phases{false};                                       ///< at some point, the control has two phases
  bool encoder_errors{false};                               ///< in some trial, an encoder may not be ideal
  /// In some trial moves may end beside their targets by design: no integral control, friction without
  /// pre-sliding motion, or moves that are long.
  bool final_error{false};
  bool stopping{false};  ///< at some point, a trial is ended where a move diverges
  /// The design is saltelli: the trials of a row share most of their numbers, and bounds that take
  /// trials for independent are too narrow.
  bool dependent_trials{false};
  bool rigs{false};  ///< trials share rigs: bounds allow for what the trials of one rig have in common
  /// The design spreads the trials more evenly than chance (latin_hypercube, sobol): bounds are wider than
  /// need be.
  bool spread_trials{false};
};

StudyFeatures study_features(const Study& study);

}  // namespace zerocount::study
