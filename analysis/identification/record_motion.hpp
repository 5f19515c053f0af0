#pragma once

#include <Eigen/Core>

#include "analysis/identification/contact_coordinates.hpp"
#include "analysis/identification/test_record.hpp"

namespace zerocount {

/// Derivatives of a path with respect to the coordinates, [sample, coordinate].
using PathSensitivity = Eigen::Matrix<double, Eigen::Dynamic, coordinate_count, Eigen::RowMajor>;

/// What the model makes of a record's torque.
struct RecordMotion {
  Eigen::VectorXd path;  ///< [sample] rotor angle since the first sample, in the record's unit
  PathSensitivity sensitivity;
};

/// One row of a PathSensitivity.
using PathSlope = Eigen::Matrix<double, 1, coordinate_count>;

/// The rotor angle at every sample, by core's Plant, to 0.01 of the record's unit. Long holds are integrated
/// in longer steps once the rotor has come to rest but for creep, and interpolated by cubics.
Eigen::VectorXd angle_path(const TestRecord& record, const ContactParameters& contact);

/// The path and, by forward differences, its derivatives with respect to the free coordinates; those of the
/// others are set to zero.
RecordMotion motion_with_sensitivity(const TestRecord& record, const ContactPoint& point, double creep_torque,
                                     const FreeCoordinates& free);

}  // namespace zerocount
