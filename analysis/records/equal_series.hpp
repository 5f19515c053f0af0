#pragma once

#include "analysis/records/raw_series.hpp"

namespace zerocount::records {

/// Whether two series are one, or one begins with all of the other: torque, angle and the time since the
/// first sample are equal to nine digits of their largest value, whatever the unit of the angle. As two
/// records they would count as independent readings.
bool are_equal(const RawSeries& one, const RawSeries& other);

}  // namespace zerocount::records
