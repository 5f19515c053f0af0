#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/record_fit/joint_fit.hpp"

namespace zerocount::record_fit {

/// A range of frequencies, Hz.
struct FrequencyRange {
  double low{0.0};
  double high{0.0};
};

/// A narrow peak in the spectrum of the residuals.
struct ResidualLine {
  std::size_t record{0};  ///< number of the record
  double frequency{0.0};  ///< Hz
};

/// The frequency at which the residuals of ring-downs oscillate although the model does not: a sign of a
/// second mass on a spring, such as a load, a coupling or the machine's base.
///
/// The spectrum is that of the residuals in the first 1024 samples of each hold that begins with a step of
/// the torque, summed over the holds of a record. It is compared with those of 1000 simulated replicates of
/// the readings along the model's path, each read at a random position between two counts. At each frequency,
/// the largest power of the first 500 is the usual one. A line is a peak whose ratio to the usual power is
/// more than twice the largest ratio of the other 500 at any frequency, and with at least half of the power
/// above the usual one within ±10 % of its frequency: a wrong friction law leaves residuals at all low
/// frequencies.
/// @param noise [record] of the readings, in the record's unit
/// @param own the oscillation of the model itself: lines are looked for outside of it
/// @returns the line with the largest ratio. Nothing if there is none, or no evenly sampled record has a
/// ring-down of 64 samples.
std::optional<ResidualLine> residual_line(Records records, const FittedModel& model,
                                          const std::vector<double>& noise, const FrequencyRange& own);

}  // namespace zerocount::record_fit
