#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/identification.hpp"
#include "analysis/sliding_identification/sliding_record.hpp"

namespace zerocount::sliding_identification {

/// The used part of a record.
struct SlidingSummary {
  std::string name;
  std::size_t samples{0};
  double duration{0.0};    ///< s
  double resolution{0.0};  ///< of the readings, rad or m
  std::size_t strokes{0};
  std::size_t windows{0};
  std::size_t used{0};       ///< samples in the windows
  double min_velocity{0.0};  ///< in the windows, rad/s or m/s
  double max_velocity{0.0};
};

/// The inertia and the sliding friction of an axis. Units are those of a rotary or of a linear axis.
struct SlidingIdentification {
  bool linear{false};
  /// inertia, sliding_damping, coulomb_level, breakaway_level, coulomb_ratio, stribeck_velocity, offset.
  std::vector<identification::ParameterEstimate> parameters;
  std::vector<SlidingSummary> records;
  double misfit{0.0};                   ///< root mean square of the residuals, in steps of the readings
  double unexplained_torque{0.0};       ///< root mean square over the windows, N m or N
  double torque{0.0};                   ///< root mean square of the torque in the windows, N m or N
  std::vector<std::string> correlated;  ///< names of the fitted parameters
  Eigen::MatrixXd correlation;          ///< of their errors, in that order
};

/// Identifies the sliding axis from motion records, under open or closed loop.
///
/// Fitted are the inertia, the Coulomb level, the viscous damping and an offset. The Stribeck curve is added
/// if the record shows it: its excess over the Coulomb level is more than 3.5 standard errors above 0, and
/// its velocity is known to a factor of 2. With motion in one direction only, the offset is taken for 0.
/// The windows begin with 256 samples. While the residuals are larger than the steps of the readings, forces
/// that the law lacks make them, which add up in a window: they are quartered, to 64 and to 16 samples.
///
/// Intervals have 95 %, by Student's t with as many degrees of freedom as there are windows less parameters.
/// @throws Failure (bad_data) if the axis accelerates against the torque, the fit leaves more than a third of
/// the torque unexplained, or records of rotary and linear axes are mixed.
SlidingIdentification identify_sliding(std::vector<SlidingRecord> records);

/// The parameters, what was used of the records, and the manifest fragment as text.
std::string sliding_text(const SlidingIdentification& identification);
/// The report as one JSON object.
std::string sliding_json(const SlidingIdentification& identification);
/// The parameters as a fragment of a manifest.
std::string sliding_fragment(const SlidingIdentification& identification);

}  // namespace zerocount::sliding_identification
