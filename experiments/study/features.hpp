#pragma once

#include <string_view>

#include "core/trial/error_bands.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::study {

/// The features of the loop that a study can use, at any point and in any trial. They decide which optional
/// columns the tables have. They follow from the ranges of the parameters, so studies that differ only in
/// their seed have the same columns.
struct StudyFeatures {
  /// Kind of axis; determines the units of the tables.
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  bool open_loop{false};     ///< the command is a list of torque levels, not of targets
  bool travel{false};        ///< the reference takes time to reach its target: it is not a step
  bool phases{false};        ///< the control has two phases: a coarse and a fine one
  bool load{false};          ///< the axis has a second mass (load) behind a coupling
  bool motor_closes{false};  ///< with a second mass, the motor's encoder closes the loop in some trial
  bool load_closes{false};   ///< with a second mass, the load's encoder closes the loop in some trial
  /// The axis has an encoder on the load, besides the motor's, and it does not close the (position) loop.
  bool load_count{false};
  /// The axis has an encoder on the load, besides the motor's, and it closes the (position) loop.
  bool motor_count{false};
  /// The load's position error has its own measures, in addition to the measures of the mass that closes the
  /// loop.
  bool load_error{false};
  /// The motor's position error has its own measures, in addition to the measures of the mass that closes the
  /// loop.
  bool motor_error{false};
  /// The motor torque differs from the (delayed) code of the converter times its resolution.
  bool drive_torque{false};
  bool encoder_errors{false};  ///< an encoder may have errors, such as noise, in some trial
  /// An encoder may have errors, and the axis has a coarse encoder besides the fine one.
  bool coarse_errors{false};
  /// Moves may end beside their targets by design: for example without integral control, with Coulomb
  /// friction, or if the reference takes time to its target.
  bool final_error{false};
  bool own_controller{false};  ///< the controller is a plugin
  bool stopping{false};        ///< a trial ends early where a move diverges
  bool motion{false};  ///< the trials measure the true motion of the axis, not only what the encoder shows
  bool steps{false};   ///< the true motion of the axis is measured, and the moves end at a target
  /// The true motion of the axis is measured, and the reference moves: it is not a step.
  bool following{false};
  bool reversals{false};  ///< the true motion of the axis is measured, and the reference is a sine
  /// The design is saltelli: the trials of a row share most of their numbers, and bounds for independent
  /// trials are too narrow.
  bool dependent_trials{false};
  /// Error bands in counts; for each, the trials measure when the error enters the band and settles in it.
  trial::ErrorBands bands{};
  /// Tolerances (rad, or m) of the position error; for each, the trials measure the settling time.
  trial::Tolerances tolerances{};
  /// The trials measure the true overshoot, and when the position error settles within the tolerances.
  bool position_error{false};
  /// Trials share machines, so the bounds account for the correlation of the trials of a machine.
  bool machines{false};
  /// The design spreads the trials more evenly than chance (latin_hypercube, sobol): bounds are wider than
  /// needed.
  bool spread_trials{false};
};

/// Words such as " of the motor" that name the mass whose encoder closes the loop, for a measure's
/// description; empty for an axis with one mass.
constexpr std::string_view of_closing_mass(const StudyFeatures& features) {
  if (features.motor_closes && features.load_closes) return " of the mass whose encoder closes the loop";
  return features.load_closes ? " of the load" : features.motor_closes ? " of the motor" : "";
}

/// The statement of a study about an effect of a real axis, such as encoder noise.
enum class PremiseState {
  considered,   ///< the effect acts in some trials of the study
  stated_none,  ///< the effect is absent, and the manifest says so: it gives the parameter as 0
  assumed       ///< the effect is absent, because the manifest does not name its parameter
};

/// The assumption that an effect of a real axis is absent, and whether it holds in a study.
struct Premise {
  std::string_view assumption;  ///< text of the assumption, "no delay"
  PremiseState state{PremiseState::assumed};
};

}  // namespace zerocount::study
