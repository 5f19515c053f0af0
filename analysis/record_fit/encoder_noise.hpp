#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/record_fit/joint_fit.hpp"

namespace zerocount::record_fit {

/// Noise of counts (standard deviation in counts, before rounding), estimated from the differences of
/// readings one or two samples apart beside the rotor's travel; 0 if an encoder without noise explains them.
/// Slow deviations from `path` have little influence. Masked and single wrong readings are not used.
double counting_noise(const TestRecord& record, const Eigen::VectorXd& path, const Eigen::VectorXd& readings);

/// Noise of counts of one encoder, estimated from the edges that slow motion passes: by the second
/// differences of their distances from the paths, beside those of readings without noise. It shows noise that
/// is too small for counting_noise(), but not in fast motion.
/// @param unit size of its count, rad or m. Other records are not used. @returns counts; 0 if an encoder
/// without noise explains the edges.
double edge_noise(Records records, const FittedModel& model, double unit);

/// [record] Noise of the readings in the record's unit: of counts by counting_noise(), of others the misfit.
///
/// Records with the same count come from the same encoder. One that is too short or too fast to show noise
/// has the smallest noise of the others; if none shows any, all have their edge_noise().
std::vector<double> noise_along(Records records, const FittedModel& model);

}  // namespace zerocount::record_fit
