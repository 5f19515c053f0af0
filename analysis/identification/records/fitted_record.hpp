#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "analysis/record_fit/test_record.hpp"

namespace zerocount::identification {

using record_fit::TestRecord;

/// A record beside the fit, sample by sample. Readings are in the record's unit.
struct FittedRecord {
  std::vector<double> time;     ///< [sample] as recorded, s
  std::vector<double> torque;   ///< [sample] of the motor, N m, without the fitted time offset
  std::vector<double> reading;  ///< [sample] as recorded; masked ones too
  std::vector<double> fitted;   ///< [sample] expected reading: the fitted angle, less half a count for counts
  std::vector<bool> excluded;   ///< [sample] masked readings
};

/// @param path [sample] fitted angle with the encoder's offset, in the record's unit
FittedRecord fitted_record(const TestRecord& record, const Eigen::VectorXd& path);

/// Reading minus fitted value of a sample, in the record's unit.
inline double residual(const FittedRecord& record, std::size_t sample) {
  return record.reading[sample] - record.fitted[sample];
}

}  // namespace zerocount::identification
