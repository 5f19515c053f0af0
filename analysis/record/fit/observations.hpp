#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "analysis/record/fit/model.hpp"
#include "analysis/record/fit/record.hpp"

namespace zerocount::fit {

struct FittedModel;

/// Variance of a uniform distribution of width 1.
inline constexpr double uniform_variance = 1.0 / 12.0;

/// An observation of the rotor: its mean angle over the samples first … last is `position`, with the variance
/// `variance`. Both refer to the record's unit and to an encoder with phase 0.
struct AngleObservation {
  std::size_t first{0};
  std::size_t last{0};
  double position{0.0};
  double variance{1.0};
};

/// Converts the readings of a record to observations with independent errors, given an approximate path.
///
/// Readings of an encoder are not angles with independent errors: at rest, thousands of them have the
/// information of one, and the transitions between counts have the most information. Therefore:
/// - Counts without noise. If the rotor moves by less than a count between the samples k and k + 1 and the
///   count changes, it passed an edge: the mean of the two angles is that of the edge, with a uniform error
///   of ±w/2, where w is the rotor's travel. If the rotor moves by a count or more, each reading is an
///   observation: the angle is the middle of the count, with a uniform error of ±½. Readings that do not
///   change give no observation.
/// - Counts with noise. Readings are averaged while the rotor stays within half a count. The error of such an
///   average has a part from quantisation, which more readings do not reduce, and a part from noise, which
///   they reduce.
/// - Other readings: each for itself, with the noise.
///
/// The choice between these cases depends only on `path`, not on the readings, because a choice by the
/// readings would bias the errors.
/// Masked samples give none.
/// @param path [sample] approximate rotor angle, including the encoder's phase.
/// @param noise standard deviation of the readings before they are rounded to counts. All in the record's
/// unit.
void observe(const TestRecord& record, const Eigen::VectorXd& path, const Eigen::VectorXd& readings,
             double noise, std::vector<AngleObservation>& observations);

/// Mean of `values` ([sample], or [sample, coordinate]) over the samples of the observation: one row.
template <class Values>
auto mean_over(const AngleObservation& observation, const Values& values) {
  const auto first = static_cast<Eigen::Index>(observation.first);
  const auto count = static_cast<Eigen::Index>(observation.last - observation.first + 1);
  return values.middleRows(first, count).colwise().mean();
}

/// Noise of counts: the standard deviation in counts before rounding. It is estimated from the differences of
/// readings one or two samples apart, compared with the rotor's travel. 0 if an encoder without noise
/// explains them. Slow deviations from `path` have little influence. Masked and single wrong readings are not
/// used.
double counting_noise(const TestRecord& record, const Eigen::VectorXd& path, const Eigen::VectorXd& readings);

/// Noise of counts of one encoder, estimated from the edges that slow motion passes. The second differences
/// of their distances from the paths are compared with the second differences for readings without noise. The
/// method finds noise that is too small for counting_noise(), but it does not work in fast motion.
/// @param unit size of the encoder's count, rad or m. Records with another unit are not used.
/// @returns standard deviation in counts; 0 if an encoder without noise explains the edges.
double edge_noise(Records records, const FittedModel& model, double unit);

/// [record] Noise of the readings in the record's unit. For counts it is counting_noise(), for other readings
/// the misfit.
///
/// Records with the same size of a count come from the same encoder. A record that is too short or too fast
/// to show noise gets the smallest noise of the encoder's other records. If none shows any, all of them get
/// edge_noise().
std::vector<double> noise_along(Records records, const FittedModel& model);

}  // namespace zerocount::fit
