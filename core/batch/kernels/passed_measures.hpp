#pragma once

#include "core/batch/kernels/lane_group.hpp"

namespace zerocount::batch {

/// Measures `passed` samples with zero error.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void measure_passed(BatchState& batch, const At& at, const P& passed) {
  MeasureLanes& q = batch.measures;
  trial::ArrivalMeasures<P> arrival;
  trial::for_each_of_arrival(LoadEach<At>{at}, arrival, q);
  trial::measure_zeros(arrival, at.load(q.limits.dwell), passed);
  trial::for_each_of_arrival(StoreEach<At>{at}, q, arrival);
}

}  // namespace zerocount::batch
