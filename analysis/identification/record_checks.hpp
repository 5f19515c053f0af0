#pragma once

#include "analysis/identification/raw_series.hpp"

namespace zerocount {

// What a series must be for identification to make sense of it. Each throws Failure (bad_data) with the place
// and the reason where it is not.

/// 100 samples or more, at times that rise, without gaps, on a regular grid: no sample is farther from the
/// nearest than a quarter of the sampling interval.
/// @returns the sampling interval, s.
double checked_sample_time(const RawSeries& series);

/// Magnitudes as they are of a rotor on its bearing's friction, in SI units. A value a thousand times too
/// large or too small for it is taken for one in another unit.
///
/// | quantity | believed |
/// | --- | --- |
/// | sampling interval | 1 µs … 20 ms |
/// | largest torque | 1e-3 … 20 N m |
/// | travel (largest less smallest angle) | 4e-6 … 0.05 rad |
/// | range of the torque over travel | 1 … 2e4 N m/rad |
void check_magnitudes(const RawSeries& series, const TestRecord& record);

/// The torque is not 0 throughout, and the angle changes.
void check_change(const RawSeries& series, const TestRecord& record);

/// The angle changes by 5 counts at least, in the sense of the torque.
void check_motion(const RawSeries& series, const TestRecord& record);

/// No single reading stands out beyond its neighbours by more than ten times what any other does.
void check_glitches(const RawSeries& series, const TestRecord& record);

/// The hook held, where the series knows.
void check_sticking(const RawSeries& series);

/// The torque is not cut off at its extremes: the DAC's code did not stay for 3 samples at the end of its
/// range; and where the torque stays at its extreme after a slow rise, the angle does not go on as if it
/// still rose and come back before it falls.
void check_clipping(const RawSeries& series, const TestRecord& record);

}  // namespace zerocount
