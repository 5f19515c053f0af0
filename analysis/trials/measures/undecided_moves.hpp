#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "analysis/basis/statistics/sums/histogram.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::measures {

/// Counts of the moves that ended off target: stalled, or still on their way when their hold ended. They are
/// undecided, neither stable nor shown unstable.
struct UndecidedMoves {
  std::int64_t moves{0};       ///< Number of moves of all trials.
  std::int64_t off_target{0};  ///< Number of moves that ended off target and are therefore undecided.
  /// Number of off-target moves whose error fell in the last half of the hold.
  std::int64_t still_falling{0};
  /// Number of moves that count as oscillating although their error fell and kept its sign, with a ripple of
  /// one count: a proportional gain makes the count chatter on the edges that it passes.
  std::int64_t falling_with_ripple{0};
  /// Number of moves whose error fell to within one count in the last half of the hold, but that had not
  /// arrived.
  std::int64_t about_to_arrive{0};
  /// Advised hold (time until the next move), s: long enough for most of the moves with a falling error. NaN
  /// if there are no such moves, or if nothing in their control brings the error to zero.
  double advised_hold{statistics::unknown};

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.moves, self.off_target, self.still_falling, self.falling_with_ripple, self.about_to_arrive);
  }
};

/// Names under which one of the counts of UndecidedMoves is reported in summaries and comparisons.
struct UndecidedCount {
  const char* name;       ///< Name in JSON.
  const char* column;     ///< Name in CSV.
  const char* long_name;  ///< Meaning of the count.
  std::int64_t UndecidedMoves::*count;
};
inline constexpr UndecidedCount undecided_counts[] = {
    {"off_target", "undecided_moves", "moves that ended off target", &UndecidedMoves::off_target},
    {"still_falling", "still_falling_moves", "of them, with an error that was still falling",
     &UndecidedMoves::still_falling},
    {"falling_with_ripple", "falling_with_ripple_moves",
     "moves that count as oscillating with an error that was still falling, but for a ripple",
     &UndecidedMoves::falling_with_ripple},
    {"about_to_arrive", "about_to_arrive_moves",
     "moves whose error had fallen to within one count, and that had not arrived",
     &UndecidedMoves::about_to_arrive},
};

/// Whether the move might arrive with a longer hold: it did not arrive, and its error fell in the last half
/// of its hold.
bool is_still_falling(const trial::MoveOutcome& move);

/// Adds a move to the counts that apply to it.
void add_move(UndecidedMoves& counts, const trial::MoveOutcome& move);

/// The sums of two sets of counts; the advised hold is left unknown.
UndecidedMoves sum_of(const UndecidedMoves& one, const UndecidedMoves& other);

/// Whether any move ended off target, falls with ripple or is about to arrive.
bool any_undecided(const UndecidedMoves& moves);

/// A sentence on the undecided moves: "…; the error was still falling in 2700 of 3000 moves at the end of the
/// hold; hold ≥ about 2.1 s". Empty unless any_undecided().
std::string undecided_sentence(const UndecidedMoves& moves);

/// A sentence for the reader of a table: the meaning of undecided moves.
inline constexpr std::string_view undecided_meaning =
    "Such moves are undecided: neither stable nor shown unstable. A longer hold decides those whose error "
    "was still falling";

/// Time from the start of a move at which an error that decays exponentially reads 0, s.
///
/// Under integral control the error e of a rotor on a spring of stiffness k obeys de/dt = −e/τ with
/// τ = T·(k·Δx + kp)/(2·ki), once the torque has caught up with the friction. τ is estimated from two
/// recorded errors, e_h at sample h = ⌈N/2⌉ and e_{N−1}. The count reads 0 once the error is below half a
/// count:
///
///   t = t_{N−1} + τ·ln(2·|e_{N−1}|),  τ = (t_{N−1} − t_h)/ln(|e_h|/|e_{N−1}|).
///
/// @param midway_error e_h.
/// @param final_error e_{N−1}; 1 ≤ |e_{N−1}| < |e_h|.
/// @param samples N.
/// @param sample_time T, s.
double time_to_zero(std::int64_t midway_error, std::int64_t final_error, std::int64_t samples,
                    double sample_time);

/// Sums over the undecided moves of a design point.
struct UndecidedSums {
  UndecidedMoves counts;  ///< The counts; `advised_hold` is not set.
  /// Histogram of the holds that the moves with a falling error are expected to need, s, rounded up to two
  /// digits.
  statistics::Histogram<double> needed_holds;

  /// Adds the moves of a trial.
  /// @param row row of the trial in the study, counted over all design points
  void add(const study::Study& study, std::int64_t row, std::span<const trial::MoveOutcome> moves);
  UndecidedSums& operator+=(const UndecidedSums& other);
  UndecidedMoves moves() const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.counts, self.needed_holds);
  }
};

}  // namespace zerocount::measures
