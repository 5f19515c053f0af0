#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/fit/report.hpp"
#include "analysis/sliding_identification/missing_torque.hpp"
#include "analysis/sliding_identification/reversal_friction.hpp"
#include "analysis/sliding_identification/second_mass.hpp"
#include "analysis/sliding_identification/sliding_record.hpp"
#include "analysis/sliding_identification/unexplained_force.hpp"

namespace zerocount::sliding_identification {

/// The inertia and the sliding friction of an axis. Units are those of a rotary or of a linear axis.
///
/// The parameters are inertia, sliding_damping, coulomb_level, breakaway_level, coulomb_ratio,
/// stribeck_velocity, offset, and for each torque that depends on the position its amplitude and phase, or
/// its slope.
struct SlidingIdentification : fit::FitReport {
  std::vector<SlidingRecord> records;  ///< with the windows of the fit
  std::vector<PositionWave> waves;     ///< torques that depend on the position
  /// Whether a torque that acts twice in a revolution or pitch would explain the records as well as one that
  /// acts once.
  bool could_be_two_periods{false};
  std::optional<SecondMass> second_mass;  ///< that the fit of one mass lacks
  std::vector<MissingTorque> missing;  ///< Torques that the law lacks and the residuals show, the best first.
  std::string impossible;              ///< See impossible_parameter().
  bool one_direction{false};           ///< Whether all strokes have the same direction.
  double misfit{0.0};                  ///< root mean square of the residuals, in resolutions
  double unexplained_torque{0.0};      ///< root mean square over the windows, N m or N
  double torque{0.0};                  ///< root mean square of the torque in the strokes, N m or N
  std::vector<FreeRun> runs;           ///< of the records
  std::vector<RepeatingForce> forces;  ///< what the unexplained torque repeats with
  std::optional<ReversalFriction> reversal;        ///< nothing without a reversal
  std::vector<std::string> correlated;             ///< names of the fitted parameters
  std::vector<std::vector<double>> correlation{};  ///< of their errors, in that order
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
/// @param records of one axis. @throws Failure (bad_data) if the axis accelerates against the torque, or the
/// fit leaves more than a third of the torque unexplained.
SlidingIdentification identify_sliding(std::vector<SlidingRecord> records);

/// Why the result must not be trusted, and what would help; empty if it may be.
///
/// The reasons: no parameter is estimated, one came out beyond its allowed range, the strokes are less than a
/// quarter of the travel, have one direction, or leave residuals that go with something (MissingTorque,
/// RepeatingForce, SecondMass).
std::string reason_of_distrust(const SlidingIdentification& identification);

/// The parameters as a fragment of a manifest. If sliding shows no level above the Coulomb level, the
/// breakaway torque is taken to be the Coulomb level.
std::string sliding_fragment(const SlidingIdentification& identification);

/// The parameters, what was used of the records, and the fragment of a manifest.
document::AnswerDescription<SlidingIdentification> sliding_answer();

}  // namespace zerocount::sliding_identification
