#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/test_record.hpp"

namespace zerocount {

/// Something that the readings say of the rotor: its mean angle over the samples first … last is `position`,
/// give or take `variance`. Both are in the record's unit, and so that the angle is a reading's where the
/// encoder has no phase.
struct AngleObservation {
  std::size_t first{0};
  std::size_t last{0};
  double position{0.0};
  double variance{1.0};
};

/// What the readings of a record say, given about where the rotor went.
///
/// Readings of an encoder are not angles with independent errors: at rest, thousands of them say no more than
/// one, and the passage from one count to the next is where they say most. So:
/// - Counts without noise. Where the rotor moves by less than a count between two samples k and k + 1 and the
///   count changes, an edge was passed in between: the mean of the two angles is the edge's, to within ±w/2,
///   uniformly, with w the rotor's way. Where it moves by a count or more, every reading counts for itself:
///   the angle is that of the count's middle, to within ±½, uniformly. Readings that do not change say
///   nothing more.
/// - Counts with noise. The readings are averaged as long as the rotor stays within half a count. The error
/// of
///   such an average is what the noise leaves of the count's width, which more readings do not reduce, and
///   noise, which they do.
/// - Other readings: each for itself, with the noise.
///
/// The choice between these depends on `path` alone, not on the readings: or it would favour some errors over
/// others.
/// @param path [sample] about where the rotor was, with the encoder's phase. @param noise standard deviation
/// of the readings before they are rounded to counts. All in the record's unit.
void observe(const TestRecord& record, const Eigen::VectorXd& path, const Eigen::VectorXd& readings,
             double noise, std::vector<AngleObservation>& observations);

/// Mean of `values` over the samples of the observation: one row, of as many columns as the values have.
template <class Values>
auto mean_over(const AngleObservation& observation, const Values& values) {
  const auto first = static_cast<Eigen::Index>(observation.first);
  const auto count = static_cast<Eigen::Index>(observation.last - observation.first + 1);
  return values.middleRows(first, count).colwise().mean();
}

/// The readings' noise (standard deviation in counts, before rounding), from how often neighbouring readings
/// differ beyond the rotor's way between them; 0 where that is no more than an encoder without noise would
/// show. The rotor's slow deviations from `path` hardly touch it.
double counting_noise(const Eigen::VectorXd& path, const Eigen::VectorXd& readings);

}  // namespace zerocount
