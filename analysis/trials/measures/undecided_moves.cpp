#include "analysis/trials/measures/undecided_moves.hpp"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/basis/statistics/unknown.hpp"

namespace zerocount::measures {
namespace {

bool falls(const trial::MoveOutcome& move) {
  return std::abs(move.final_error) < std::abs(move.midway_error);
}

/// Whether the encoder count went towards the target throughout the last half of the hold, except for a
/// ripple of one count to either side. The last error is 2 counts or more, so the error has kept its sign.
bool falls_with_ripple(const trial::MoveOutcome& move) {
  const auto fallen = static_cast<double>(std::abs(move.midway_error) - std::abs(move.final_error));
  return falls(move) && std::abs(move.final_error) >= 2 && 2.0 * move.oscillation_amplitude <= fallen + 2.0;
}

/// Whether the error fell to within one count in the last half of the hold, but too late for an arrival.
/// False if the error was within one count throughout the last half: such a move oscillates about the target
/// (hunting).
bool is_about_to_arrive(const trial::MoveOutcome& move) {
  return !move.arrived && std::abs(move.midway_error) >= 2 && falls(move);
}

/// The member of UndecidedMoves that counts a move with a falling error; null for any other move.
std::int64_t UndecidedMoves::*falling_count(const trial::MoveOutcome& move) {
  switch (move.outcome) {
    case trial::Outcome::off_target:
      return falls(move) ? &UndecidedMoves::still_falling : nullptr;
    case trial::Outcome::oscillating:
      return falls_with_ripple(move) ? &UndecidedMoves::falling_with_ripple : nullptr;
    case trial::Outcome::zero_count:
    case trial::Outcome::one_count:
      return is_about_to_arrive(move) ? &UndecidedMoves::about_to_arrive : nullptr;
    case trial::Outcome::nonfinite:
    case trial::Outcome::open_loop:
      break;
  }
  return nullptr;
}

}  // namespace

bool is_still_falling(const trial::MoveOutcome& move) {
  return falling_count(move) != nullptr;
}

void add_move(UndecidedMoves& counts, const trial::MoveOutcome& move) {
  ++counts.moves;
  counts.off_target += move.outcome == trial::Outcome::off_target;
  if (const auto count = falling_count(move)) ++(counts.*count);
}

UndecidedMoves sum_of(const UndecidedMoves& one, const UndecidedMoves& other) {
  UndecidedMoves sum{.moves = one.moves + other.moves};
  for (const UndecidedCount& each : undecided_counts) sum.*each.count = one.*each.count + other.*each.count;
  return sum;
}

bool any_undecided(const UndecidedMoves& moves) {
  return moves.off_target > 0 || moves.falling_with_ripple > 0 || moves.about_to_arrive > 0;
}

std::string undecided_sentence(const UndecidedMoves& moves) {
  if (!any_undecided(moves)) return {};
  std::string text =
      fmt::format("{} of {} moves ended more than one count off their target without oscillating",
                  moves.off_target, moves.moves);
  if (moves.still_falling > 0) {
    text += fmt::format("; the error was still falling in {} of {} moves at the end of the hold",
                        moves.still_falling, moves.moves);
  } else if (moves.off_target > 0) {
    text += "; in none of them was the error still falling: they have stalled";
  }
  if (moves.falling_with_ripple > 0) {
    text += fmt::format("; it was falling, with a ripple of one count, in {} more that count as oscillating",
                        moves.falling_with_ripple);
  }
  if (moves.about_to_arrive > 0) {
    text += fmt::format("; it had fallen to within one count, without arrival, in {} more",
                        moves.about_to_arrive);
  }
  if (!std::isnan(moves.advised_hold)) text += fmt::format("; hold ≥ about {:.4g} s", moves.advised_hold);
  return text;
}

}  // namespace zerocount::measures
