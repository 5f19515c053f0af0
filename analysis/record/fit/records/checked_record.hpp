#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/record/fit/record.hpp"
#include "analysis/record/records/raw_series.hpp"

namespace zerocount::fit {

using records::place_of;
using records::RawSeries;
using records::TorqueKind;

/// Kind of the axis (rotary or linear) on which a series was recorded.
inline parameters::AxisKind axis_of(const RawSeries& series) {
  return series.linear ? parameters::AxisKind::linear : parameters::AxisKind::rotary;
}

/// Checks a series of torques and angles, and converts it to a record for the fit. The record ends where the
/// contact begins to slide, and its note says so: where the series flags it, or, in a series without flags,
/// where find_gross_sliding() finds it.
/// @param any_magnitude whether to accept values that suggest other units
/// @throws Failure (bad_data) with the reason if a check fails.
TestRecord checked_record(const RawSeries& series, bool any_magnitude);

/// [sample] The course of the torque over each sample interval. If the motor torque was sampled behind an
/// amplifier of known bandwidth, its samples u and u′ at both ends of an interval are two points of one
/// exponential, which gives the commanded torque.
/// @param record record whose sampling intervals are used
std::vector<motion::TorqueCourse> courses_of(const RawSeries& series, const TestRecord& record);

// Requirements on a series. Each check throws Failure (bad_data) with the place and the reason.

/// Requires at least 100 samples with increasing times, without gaps: no interval is longer than 1.75 times
/// the usual one (the median), because the torque in between is unknown, or shorter than a tenth of it.
/// @returns the sampling interval, s.
double checked_sample_time(const RawSeries& series);

/// [sample] Interval after the sample, s, if the checked times deviate from a regular grid by more than a
/// quarter of the sampling interval. Empty for a series on the grid, whose deviations are taken as errors of
/// its clock.
std::vector<double> uneven_intervals(const RawSeries& series);

/// Requires magnitudes that are plausible for an axis on its bearing's friction, in SI units. Values wrong by
/// a factor of a thousand suggest another unit.
///
/// | quantity | rotary axis | linear axis |
/// | --- | --- | --- |
/// | sampling interval | 1 µs … 20 ms | 1 µs … 20 ms |
/// | largest torque or force | 1e-3 … 20 N m | 1e-3 … 2e4 N |
/// | travel (maximum − minimum) | 4e-6 … 0.05 rad | 5e-9 … 0.01 m |
/// | range of the torque or force over travel | 1 … 2e4 N m/rad | 100 … 1e10 N/m |
void check_magnitudes(const RawSeries& series, const TestRecord& record);

/// Throws a Failure unless the torque is different from 0 at some sample, and the angle changes.
void check_change(const RawSeries& series, const TestRecord& record);

/// Requires a travel of at least 5 counts, in the direction of the torque. Friction takes energy: where the
/// torque takes it from the motion, one of both has the wrong sign; where it gives energy and the angle does
/// not rise with the torque all the same, the axis slides.
void check_motion(const RawSeries& series, const TestRecord& record);

/// Throws a Failure if the angle has a step of a quarter of the travel or more that stays, and is 50 times as
/// long as all other steps within 10 samples, without a step of the torque: no motion is like that.
void check_jumps(const RawSeries& series);

/// Throws a Failure if a single reading is an outlier: its distance from its neighbours is more than ten
/// times that of all other readings.
void check_glitches(const RawSeries& series, const TestRecord& record);

/// Throws a Failure if the torque is clipped: a DAC code stays at the end of its range for 3 samples, or the
/// torque stays at its extreme after a slow rise while the angle continues and returns.
void check_clipping(const RawSeries& series, const TestRecord& record);

/// The readings of a record with the values of the fit, sample by sample. Readings are in the record's unit.
struct FittedRecord {
  std::vector<double> time;     ///< [sample] Time as recorded, s.
  std::vector<double> torque;   ///< [sample] Motor torque, N m, without the fitted time offset.
  std::vector<double> reading;  ///< [sample] Readings as recorded, including masked ones.
  /// [sample] Expected reading: the fitted angle, minus half a count if the readings are counts.
  std::vector<double> fitted;
  std::vector<bool> excluded;  ///< [sample] Whether the reading is masked, so that the fit does not use it.
};

/// The readings of a record with the values of its fit.
/// @param path [sample] fitted angle with the encoder's offset, in the record's unit
FittedRecord fitted_record(const TestRecord& record, const Eigen::VectorXd& path);

/// Residual of a sample: reading minus fitted value, in the record's unit.
inline double residual(const FittedRecord& record, std::size_t sample) {
  return record.reading[sample] - record.fitted[sample];
}

/// A part of a series in which the rotor slides, found from torque and angle.
struct GrossSliding {
  std::size_t first{0};  ///< Index of a sample at or shortly before the breakaway.
  std::size_t seen{0};   ///< Index of the sample at which sliding is certain.
  /// Travel in the window of samples that ends at `seen`, in the unit of the series' angle.
  double travel{0.0};
  /// Range (maximum − minimum) of the angle before the window that ends at `seen`, in the unit of the series'
  /// angle.
  double travel_before{0};
};

/// Finds the first gross sliding of a material test.
///
/// Before the rotor slides, its travel is that of a spring with creep. Elastic travel grows with the range of
/// the torque, creep with its power n. Both are largest at the first visit of a torque. The rotor slides if
///
///   |θ(k) − θ(k − w)| ≥ 5·X·(U₁/U₀)³,
///
/// with the travel X up to the sample k − w, the range U₁ of the torque up to k, and the range U₀ up to
/// k − 3w, so that the rotor has had time to follow. The factor 5 allows for overshoot after a step and for
/// a spring that softens, the exponent for creep with n up to 3. The windows w are 8, 16, 32 … samples, at
/// most a quarter of the record before, so that they have little creep.
///
/// A leap between two samples is a fault of the reading and not motion: no step may be more than half of the
/// travel in the window. Masked readings are replaced by the last one before.
///
/// Not found: slides that are short compared with the travel before, and slides without pre-sliding travel
/// before them.
std::optional<GrossSliding> find_gross_sliding(const records::RawSeries& series);

}  // namespace zerocount::fit
