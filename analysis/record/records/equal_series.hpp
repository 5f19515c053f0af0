#pragma once

#include "analysis/record/records/raw_series.hpp"

namespace zerocount::records {

/// Whether two recorded series are the same measurement, or one is the beginning of the other. Torque, angle
/// and the time since the first sample must be equal to nine digits of their largest value, whatever the unit
/// of the angle. Used as two records, such series would wrongly count as independent readings.
bool are_equal(const RawSeries& one, const RawSeries& other);

}  // namespace zerocount::records
