#pragma once

#include <string_view>

#include "core/trial/error_bands.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::study {

/// The features of the loop that a study can use, at any point and in any trial: decides which optional
/// columns its tables have. Found from the limits of the parameters, so that studies which differ only in
/// their seed have the same columns.
struct StudyFeatures {
  parameters::AxisKind axis{parameters::AxisKind::rotary};  ///< whose units the tables have
  bool open_loop{false};                                    ///< torque levels in place of targets
  bool travel{false};                                       ///< the reference takes time to its target
  bool phases{false};                                       ///< the control has two phases
  bool load{false};                                         ///< there is a second mass
  bool motor_closes{false};  ///< With a second mass: in some trial the encoder of the motor closes the loop.
  bool load_closes{false};   ///< Likewise that of the load.
  bool load_count{false};    ///< it has an encoder of its own, which does not close the (position) loop
  bool motor_count{false};   ///< it has one, which closes that loop
  bool load_error{false};    ///< its position error has measures of its own
  bool motor_error{false};   ///< that of the motor has
  bool drive_torque{false};  ///< the motor torque is not the (delayed) code times the resolution
  bool encoder_errors{false};  ///< an encoder may have errors
  bool coarse_errors{false};   ///< An encoder may have errors, and there is a coarse one beside the fine one.
  /// Moves may end beside their targets by design: no integral control, Coulomb friction, or moves that are
  /// long.
  bool final_error{false};
  bool own_controller{false};  ///< the controller is a plugin
  bool stopping{false};        ///< a trial is ended where a move diverges
  bool motion{false};          ///< the true motion is measured
  bool steps{false};           ///< and the moves end at a target
  bool following{false};       ///< and the reference is not a step
  bool reversals{false};       ///< and it is a sine
  /// The design is saltelli: the trials of a row share most of their numbers, and bounds for independent
  /// trials are too narrow.
  bool dependent_trials{false};
  trial::ErrorBands bands{};       ///< bands of the error whose entry and settling are measured
  trial::Tolerances tolerances{};  ///< of the position error, for which settling is measured
  bool position_error{false};      ///< the true overshoot, and settling within the tolerances, are measured
  bool machines{
      false};  ///< trials share machines: the bounds account for the correlation of the trials of a machine
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
  considered,   ///< it acts in some trials
  stated_none,  ///< the manifest gives its parameter as 0
  assumed       ///< the manifest does not name it, and the trials are without it
};

/// The assumption that an effect of a real axis is absent.
struct Premise {
  std::string_view assumption;  ///< "no delay"
  PremiseState state{PremiseState::assumed};
};

}  // namespace zerocount::study
