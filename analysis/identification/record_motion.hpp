#pragma once

#include <Eigen/Core>

#include "analysis/identification/contact_coordinates.hpp"
#include "analysis/identification/test_record.hpp"

namespace zerocount::identification {

/// Derivatives of a path with respect to the coordinates, [sample, coordinate].
using PathSensitivity = Eigen::Matrix<double, Eigen::Dynamic, coordinate_count, Eigen::RowMajor>;

/// Modelled motion of a record.
struct RecordMotion {
  Eigen::VectorXd path;  ///< [sample] rotor angle since the first sample, in the record's unit
  PathSensitivity sensitivity;
};

/// One row of a PathSensitivity.
using PathSlope = Eigen::Matrix<double, 1, coordinate_count>;

/// The rotor angle at every sample, simulated with core's Plant to 0.01 of the record's unit. When only creep
/// moves the rotor in a long hold of an evenly sampled record, the steps are longer and the samples are
/// interpolated by cubics.
///
/// The torque acts `offset` samples later than recorded, and later by the record's delay_fraction; of uneven
/// samples, so many mean intervals. That is the same as readings so much earlier: a fraction of a sample
/// places each reading between two changes of the torque. Before its first torque the rotor rests; after the
/// last one the torque stays.
Eigen::VectorXd angle_path(const TestRecord& record, const ContactParameters& contact, double offset = 0.0);

/// The path at a point of the fit, with its time offset.
Eigen::VectorXd angle_path(const TestRecord& record, const ContactPoint& point, double creep_torque);

/// The path and its derivatives with respect to the free coordinates, by forward differences, that with
/// respect to the time offset from the velocity; the other columns are zero.
RecordMotion motion_with_sensitivity(const TestRecord& record, const ContactPoint& point, double creep_torque,
                                     const FreeCoordinates& free);

}  // namespace zerocount::identification
