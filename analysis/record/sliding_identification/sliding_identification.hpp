#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/record/fit/report.hpp"
#include "analysis/record/sliding_identification/missing_torque.hpp"
#include "analysis/record/sliding_identification/reversal_friction.hpp"
#include "analysis/record/sliding_identification/second_mass.hpp"
#include "analysis/record/sliding_identification/sliding_record.hpp"
#include "analysis/record/sliding_identification/unexplained_force.hpp"

namespace zerocount::sliding_identification {

/// The inertia and the sliding friction of an axis. Units are those of a rotary or of a linear axis.
///
/// The parameters are inertia, sliding_damping, coulomb_level, breakaway_level, coulomb_ratio,
/// stribeck_velocity, offset, and for each torque that depends on the position its amplitude and phase, or
/// its slope.
struct SlidingIdentification : fit::FitReport {
  std::vector<SlidingRecord> records;  ///< Records with the windows (simulated pieces) of the fit.
  std::vector<PositionWave> waves;     ///< Torques that depend on the position.
  /// Whether a torque that acts twice in a revolution or pitch would explain the records as well as one that
  /// acts once.
  bool could_be_two_periods{false};
  /// Second mass that the records show beyond the fitted single mass; nothing if none is found.
  std::optional<SecondMass> second_mass;
  /// Torques that the law lacks and the residuals show, the most visible first.
  std::vector<MissingTorque> missing;
  /// Sentence on a parameter whose allowed values do not fit the records, see impossible_parameter(); empty
  /// if there is none.
  std::string impossible;
  bool one_direction{false};  ///< Whether all strokes have the same direction.
  double misfit{0.0};         ///< Root mean square of the residuals, in units of the records' resolution.
  /// Root mean square of the unexplained torque over the windows, N m or N.
  double unexplained_torque{0.0};
  /// Root mean square of the drive torque while the axis slides (in the strokes), N m or N.
  double torque{0.0};
  /// [record] Simulated motion over the whole record without restarts, to compare with the readings.
  std::vector<FreeRun> runs;
  /// Quantities, such as the position, with which the unexplained torque repeats.
  std::vector<RepeatingForce> forces;
  /// Friction at reversals; nothing if the records have none.
  std::optional<ReversalFriction> reversal;
  /// Names of the fitted parameters, in the order of `correlation`.
  std::vector<std::string> correlated;
  /// Correlation matrix of the errors of the fitted parameters, in the order of `correlated`.
  std::vector<std::vector<double>> correlation{};
};

/// Identifies the sliding axis from motion records, under open or closed loop.
///
/// Fitted are the inertia, the Coulomb level, the viscous damping and an offset. The Stribeck curve is added
/// if the record shows it: its excess over the Coulomb level is more than 3.5 standard errors above 0, and
/// its velocity is known to a factor of 2. With motion in one direction only, the offset is taken for 0, and
/// the Coulomb level, which then contains it, is not told.
/// The windows begin with 256 samples. While the residuals are larger than the steps of the readings, forces
/// that the law lacks make them, which add up in a window: they are quartered, to 64 and to 16 samples.
///
/// A torque that depends on the position (PositionWave) is added if its amplitudes exclude 0: gravity, or
/// what else repeats with the revolution or the pitch; of a linear axis a slope. Up to max_position_waves.
///
/// Intervals have 95 %, by Student's t with as many degrees of freedom as there are windows less parameters.
/// @param records records of one axis
/// @throws Failure (bad_data) if the axis accelerates against the torque, or the fit leaves more than a third
/// of the torque unexplained.
SlidingIdentification identify_sliding(std::vector<SlidingRecord> records);

/// Sentence with a reason why the result must not be trusted, and a remedy; empty if it may be trusted.
///
/// Possible reasons: no parameter is estimated; one came out beyond its allowed range; the strokes are less
/// than a quarter of the travel, or have one direction; the residuals vary with something (MissingTorque,
/// RepeatingForce, SecondMass).
std::string reason_of_distrust(const SlidingIdentification& identification);

/// The identified parameters as a fragment of a manifest (YAML). If sliding shows no level above the Coulomb
/// level, the breakaway torque is taken to be the Coulomb level.
std::string sliding_fragment(const SlidingIdentification& identification);

/// The answer to the user: the parameters, the used parts of the records, and the fragment of a manifest.
document::AnswerDescription<SlidingIdentification> sliding_answer();

}  // namespace zerocount::sliding_identification
