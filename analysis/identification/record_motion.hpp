#pragma once

#include <Eigen/Core>

#include "analysis/identification/contact_coordinates.hpp"
#include "analysis/identification/test_record.hpp"
#include "core/plant/plant.hpp"

namespace zerocount::identification {

inline Eigen::Map<const Eigen::VectorXd> readings_of(const TestRecord& record) {
  return {record.reading.data(), static_cast<Eigen::Index>(record.reading.size())};
}

/// Derivatives of a path with respect to the coordinates, [sample, coordinate].
using PathSensitivity = Eigen::Matrix<double, Eigen::Dynamic, coordinate_count, Eigen::RowMajor>;

/// Modelled motion of a record.
struct RecordMotion {
  Eigen::VectorXd path;  ///< [sample] rotor angle since the first sample, in the record's unit
  PathSensitivity sensitivity;
};

/// Truncation error allowed per step of a motion along a record, in units of the readings.
inline constexpr double motion_tolerance = 1e-9;

/// Step of the finite differences with respect to coordinates: small enough for a smooth path, far above the
/// error of the integration.
inline constexpr double difference_step = 1e-6;

/// The path of a record and its velocity.
struct SampledPath {
  Eigen::VectorXd angle;     ///< [sample] in the record's unit
  Eigen::VectorXd velocity;  ///< [sample] in units per sample
};

/// Steps of several samples in a long hold of an evenly sampled record, where only creep moves the rotor. By
/// default there are none.
struct LongSteps {
  double settled_after{1e9};  ///< time after the last change of the torque from which they are taken, s
  double longest{0.0};        ///< s
};

/// The motion of a plant along a record. The torque acts `offset` samples later than recorded, as in
/// angle_path().
SampledPath sampled_path(const TestRecord& record, plant::Plant plant, double offset,
                         const LongSteps& steps = {});

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
