#pragma once

#include "core/numerics/number.hpp"

/// The measures of a move that change with every sample, for double and for the vectors of the batch engine.
namespace zerocount::trial {

/// The measures of the arrival at the target, up to the present sample. Flags are 0 or 1, whole numbers
/// exact.
/// @tparam Number double, a vector, or an array with the numbers of many lanes.
template <class Number>
struct ArrivalMeasures {
  Number samples;         ///< Samples so far
  Number zeros_in_a_row;  ///< Successive samples with zero error up to the last sample
  Number arrived;         ///< 1 if the error was 0 for the whole dwell
  Number arrival;         ///< First sample of the arrival dwell; valid once arrived
};

/// Measures of a move, accumulated up to the present sample.
template <class Number>
struct RunningMeasures : ArrivalMeasures<Number> {
  Number direction;              ///< sgn e_0
  Number largest_since_arrival;  ///< max |e| after the dwell, counts
  Number largest_in_window;      ///< max |e| in the last W samples, counts
  Number overshoot;              ///< Largest excursion beyond the target, counts
  Number peak_torque;            ///< max |torque decided|, N m
  Number saturated;              ///< 1 if the converter has clipped
};

/// Calls `visit` for each member in turn, with that member of all `arrivals`. for_each_measure does so for
/// `measures`.
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

/// Measures of one error band |e| ≤ b, as of the last sample outside it. A run of samples inside the band
/// counts when it ends.
template <class Number>
struct BandMeasures {
  Number last_outside;  ///< Last sample with |e| > b; −1 if none
  Number entry;         ///< First sample of the first dwell inside the band; −1 if none has ended
  Number exits;         ///< Number of maximal runs of samples with |e| > b after the entry dwell
};

/// Limits that the running measures compare with, in samples.
template <class Number>
struct MeasureLimits {
  Number samples;  ///< Number N of samples of the move
  Number dwell;    ///< Arrival dwell D
  Number window;   ///< Window W
};

/// Updates the measures by the error of the next sample (counts).
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

/// Takes sample k, at which |e| is `size` counts. Samples inside the band may be left out.
/// @param limit b of the band, counts. @param dwell D, samples @returns a mask: true if the sample lies
/// outside the band.
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

/// Updates the measures by the torque (N m) decided at this sample, and ends the sample.
template <class Number, class Mask>
ZEROCOUNT_ALWAYS_INLINE void measure_torque(RunningMeasures<Number>& m, const Number& torque,
                                            const Mask& clipped) {
  m.peak_torque = max(m.peak_torque, abs(torque));
  m.saturated = select(clipped, Number(1.0), m.saturated);
  m.samples = m.samples + Number(1.0);
}

/// Adds `samples` samples (0 or more) with zero error and the last torque.
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
