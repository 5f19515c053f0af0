#pragma once

#include <cstdint>
#include <span>

#include "analysis/measures/undecided_moves.hpp"
#include "analysis/statistics/sums/histogram.hpp"
#include "analysis/summary/summary.hpp"
#include "experiments/study/study.hpp"

/// Moves that are off target: stalled, or still on their way when their hold ended. They are undecided,
/// neither stable nor shown unstable.
namespace zerocount::summary {

/// Time from the start of a move at which an error that decays exponentially reads 0, s.
///
/// Under integral control the error e of a rotor on a spring of stiffness k obeys de/dt = −e/τ with
/// τ = T·(k·Δx + kp)/(2·ki), once the torque has caught up with the friction. The rate comes from what was
/// recorded, e_h at sample h = ⌈N/2⌉ and e_{N−1}, and the count reads 0 from half a count on:
///
///   t = t_{N−1} + τ·ln(2·|e_{N−1}|),  τ = (t_{N−1} − t_h)/ln(|e_h|/|e_{N−1}|).
///
/// @param midway_error e_h. @param final_error e_{N−1}; 1 ≤ |e_{N−1}| < |e_h|.
/// @param samples N. @param sample_time T, s.
double time_to_zero(std::int64_t midway_error, std::int64_t final_error, std::int64_t samples,
                    double sample_time);

/// Sums over the undecided moves of a design point.
struct UndecidedSums {
  measures::UndecidedMoves counts;             ///< without the advised hold
  statistics::Histogram<double> needed_holds;  ///< of the moves still falling, rounded up to two digits, s

  /// Adds a trial. @param row of the study
  void add(const study::Study& study, std::int64_t row, std::span<const trial::MoveOutcome> moves);
  UndecidedSums& operator+=(const UndecidedSums& other);
  measures::UndecidedMoves moves() const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.counts, self.needed_holds);
  }
};

}  // namespace zerocount::summary
