#pragma once

#include <Eigen/Core>

#include "analysis/record_fit/test_record.hpp"
#include "core/plant/plant.hpp"

namespace zerocount::record_fit {

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

/// The motion of a plant along a record, at every sample.
///
/// The torque acts `offset` samples later than recorded, and later by the record's delay_fraction; of uneven
/// samples, so many mean intervals. That is the same as readings so much earlier: a fraction of a sample
/// places each reading between two changes of the torque. Before its first torque the rotor rests; after the
/// last one the torque stays.
SampledPath sampled_path(const TestRecord& record, plant::Plant plant, double offset,
                         const LongSteps& steps = {});

}  // namespace zerocount::record_fit
