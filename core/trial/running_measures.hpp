#pragma once

#include "core/numerics/number.hpp"

/// Measures of a move that change with every sample, as templates for double and for the vectors of the batch
/// engine.
namespace zerocount::trial {

/// Measures of the arrival at the target, accumulated up to the present sample. Flags are 0 or 1, whole
/// numbers are exact.
/// @tparam Number double, a vector, or an array with one number per lane of the batch engine.
template <class Number>
struct ArrivalMeasures {
  Number samples;         ///< Number of samples so far
  Number zeros_in_a_row;  ///< Successive samples with zero error up to the last sample
  Number arrived;         ///< 1 once the error has been 0 for the whole dwell time, otherwise 0
  Number arrival;  ///< Number of the sample from which the error first stayed 0 for the dwell time; valid
                   /// < once `arrived` is 1
};

/// Measures of a move, accumulated up to the present sample.
template <class Number>
struct RunningMeasures : ArrivalMeasures<Number> {
  Number direction;              ///< Sign of the error at the first sample, sgn e_0
  Number largest_since_arrival;  ///< Largest |e| since the error first stayed 0 for the dwell time, counts
  Number largest_in_window;      ///< Largest |e| in the last W samples of the move, counts
  Number overshoot;              ///< Largest excursion of the count beyond the target, counts
  Number peak_torque;            ///< Largest |torque decided| so far, N m
  Number saturated;              ///< 1 once the converter's range has been exceeded, otherwise 0
};

/// Calls `visit` once for each data member of ArrivalMeasures, with that member of all objects in `arrivals`
/// as arguments.
template <class Visit, class... Arrivals>
ZEROCOUNT_ALWAYS_INLINE constexpr void for_each_of_arrival(Visit visit, Arrivals&... arrivals) {
  visit(arrivals.samples...);
  visit(arrivals.zeros_in_a_row...);
  visit(arrivals.arrived...);
  visit(arrivals.arrival...);
}
template <class Visit, class... Measures>
ZEROCOUNT_ALWAYS_INLINE constexpr void for_each_measure(Visit visit, Measures&... measures) {
  for_each_of_arrival(visit, measures...);
  visit(measures.direction...);
  visit(measures.largest_since_arrival...);
  visit(measures.largest_in_window...);
  visit(measures.overshoot...);
  visit(measures.peak_torque...);
  visit(measures.saturated...);
}
static_assert(
    [] {
      RunningMeasures<double> measures{};
      double visited = 0.0;
      for_each_measure([&visited](double&) { visited += 1.0; }, measures);
      return visited * sizeof(double) == sizeof(measures);
    }(),
    "a measure that is not visited would have the value of the lane's last trial");

/// Maximum number of error bands of a study.
inline constexpr int max_error_bands = 8;

/// Measures of one error band |e| ≤ b, up to the last sample outside the band. A run of samples inside the
/// band counts when it ends.
template <class Number>
struct BandMeasures {
  Number last_outside;  ///< Number of the last sample with |e| > b; −1 if there is none
  Number entry;  ///< Number of the sample from which the error first stayed in the band for the dwell time;
                 /// < −1 if no such stay has ended
  Number exits;  ///< Number of times that the error left the band after it had first stayed in it for the
                 /// < dwell time
};

/// Lengths, in samples, that the running measures of a move need.
template <class Number>
struct MeasureLimits {
  Number samples;  ///< Number N of samples of the move
  Number dwell;    ///< Dwell D: number of successive samples with zero error that make an arrival
  Number window;   ///< Window W: last samples of the move, which decide its outcome
};

/// Updates the measures of a move by the error at the next sample (counts). Call measure_torque() for the
/// same sample afterwards.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE void measure_error(RunningMeasures<Number>& m, const MeasureLimits<Number>& limits,
                                           const Number& error) {
  const Number zero(0.0);
  const Number one(1.0);
  const Number size = abs(error);
  m.direction = select(m.samples == zero, sign(error), m.direction);
  const auto dwelt = m.arrived != zero;  // the dwell ended before this sample
  m.zeros_in_a_row = select(error == zero, m.zeros_in_a_row + one, zero);
  const auto arrives = (m.arrived == zero) & (m.zeros_in_a_row == limits.dwell);
  m.arrived = select(arrives, one, m.arrived);
  m.arrival = select(arrives, m.samples - limits.dwell + one, m.arrival);
  m.largest_since_arrival = select(dwelt, max(m.largest_since_arrival, size), m.largest_since_arrival);
  m.largest_in_window = select(m.samples >= limits.samples - limits.window, max(m.largest_in_window, size),
                               m.largest_in_window);
  m.overshoot = max(m.overshoot, -m.direction * error);
}

/// Updates the measures of an error band by sample k of the move. Samples inside the band may be left out.
/// @param limit half width b of the band, counts.
/// @param dwell D, samples.
/// @param size |e| at sample k, counts.
/// @returns a mask: true if the sample lies outside the band.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE auto measure_band(BandMeasures<Number>& band, const Number& limit,
                                          const Number& dwell, const Number& k, const Number& size) {
  const Number zero(0.0);
  const Number one(1.0);
  const auto outside = size > limit;
  const Number inside = k - one - band.last_outside;  // samples in a row before this one
  const auto enters = outside & (band.entry < zero) & (inside >= dwell);
  band.entry = select(enters, band.last_outside + one, band.entry);
  const auto exits = outside & (band.entry >= zero) & (inside > zero);
  band.exits = select(exits, band.exits + one, band.exits);
  band.last_outside = select(outside, k, band.last_outside);
  return outside;
}

/// Updates the measures of a move by the torque (N m) decided at this sample, and counts the sample. Call
/// measure_error() for the same sample before.
template <class Number, class Mask>
ZEROCOUNT_ALWAYS_INLINE void measure_torque(RunningMeasures<Number>& m, const Number& torque,
                                            const Mask& clipped) {
  m.peak_torque = max(m.peak_torque, abs(torque));
  m.saturated = select(clipped, Number(1.0), m.saturated);
  m.samples = m.samples + Number(1.0);
}

/// Updates the measures for `samples` further samples (0 or more) with zero error and the last torque.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE void measure_zeros(ArrivalMeasures<Number>& m, const Number& dwell,
                                           const Number& samples) {
  const Number zero(0.0);
  const auto arrives = (m.arrived == zero) & (samples > zero) & (m.zeros_in_a_row + samples >= dwell);
  m.arrived = select(arrives, Number(1.0), m.arrived);
  m.arrival = select(arrives, m.samples - m.zeros_in_a_row, m.arrival);
  m.zeros_in_a_row = m.zeros_in_a_row + samples;
  m.samples = m.samples + samples;
}

}  // namespace zerocount::trial
