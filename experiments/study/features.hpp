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
  bool travel{false};        ///< the reference takes time to its target
  bool phases{false};        ///< the control has two phases
  bool load{false};          ///< there is a second mass
  bool motor_closes{false};  ///< with a second mass, the motor's encoder closes the loop in some trial
  bool load_closes{false};   ///< with a second mass, the load's encoder closes the loop in some trial
  bool load_count{false};    ///< the load has its own encoder, which does not close the (position) loop
  bool motor_count{false};   ///< the load has its own encoder, which closes the (position) loop
  /// The load's position error has its own measures, in addition to the measures of the mass that closes the
  /// loop.
  bool load_error{false};
  /// The motor's position error has its own measures, in addition to the measures of the mass that closes the
  /// loop.
  bool motor_error{false};
  bool drive_torque{false};    ///< the motor torque is not the (delayed) code times the resolution
  bool encoder_errors{false};  ///< an encoder may have errors
  bool coarse_errors{false};   ///< an encoder may have errors, and there is a coarse encoder
  /// Moves may end beside their targets by design: for example without integral control, with Coulomb
  /// friction, or if the reference takes time to its target.
  bool final_error{false};
  bool own_controller{false};  ///< the controller is a plugin
  bool stopping{false};        ///< a trial is ended where a move diverges
  bool motion{false};          ///< the true motion is measured
  bool steps{false};           ///< the true motion is measured, and the moves end at a target
  bool following{false};       ///< the true motion is measured, and the reference is not a step
  bool reversals{false};       ///< the true motion is measured, and the reference is a sine
  /// The design is saltelli: the trials of a row share most of their numbers, and bounds for independent
  /// trials are too narrow.
  bool dependent_trials{false};
  trial::ErrorBands bands{};       ///< bands of the error whose entry and settling are measured
  trial::Tolerances tolerances{};  ///< tolerances of the position error for which settling is measured
  bool position_error{false};      ///< the true overshoot, and settling within the tolerances, are measured
  /// Trials share machines, so the bounds account for the correlation of the trials of a machine.
  bool machines{false};
  /// The design spreads the trials more evenly than chance (latin_hypercube, sobol): bounds are wider than
  /// needed.
  bool spread_trials{false};
};

/// Words such as " of the motor" for the mass whose encoder closes the loop; empty for an axis with one mass.
constexpr std::string_view of_closing_mass(const StudyFeatures& features) {
  if (features.motor_closes && features.load_closes) return " of the mass whose encoder closes the loop";
  return features.load_closes ? " of the load" : features.motor_closes ? " of the motor" : "";
}

/// Whether a study has an effect of a real axis.
enum class PremiseState {
  considered,   ///< the effect acts in some trials
  stated_none,  ///< the effect is absent, and the manifest says so: it gives the parameter as 0
  assumed       ///< the effect is absent, because the manifest does not name its parameter
};

/// The assumption that an effect of a real axis is absent.
struct Premise {
  std::string_view assumption;  ///< text of the assumption, "no delay"
  PremiseState state{PremiseState::assumed};
};

}  // namespace zerocount::study
