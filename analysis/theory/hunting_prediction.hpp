#pragma once

#include <cstdint>
#include <optional>

#include "analysis/document/description.hpp"
#include "core/trial/parameters.hpp"

/// Hunting, the lasting oscillation of a position loop with friction, as trials of the loop show it.
namespace zerocount::theory {

enum class Hunting : std::uint8_t {
  rests,     ///< the axis comes to rest, or stays within a count of its target
  hunts,     ///< it oscillates for good
  diverges,  ///< the motion leaves the finite numbers
  undecided  ///< neither is seen in the longest trial
};

struct HuntingPrediction {
  Hunting state{Hunting::undecided};
  std::int64_t step{0};   ///< of the move, counts
  double amplitude{0.0};  ///< half of the range of the count, counts; where it hunts
  double period{0.0};     ///< s; where it hunts
  double duration{0.0};   ///< of the longest trial, s
};

/// The trial with its longest move alone, which is held for 2¹³, 2¹⁴ … 2¹⁷ samples until it
///
///     rests   the error is 0 for good before half of the hold, or at most a count in the last half of two
///     holds hunts   in the last half of the hold the count oscillates by more than a count on either side,
///     over two
///             periods at least, and by as much as in the hold before, within 5 %
///
/// so that a decay is told from a cycle unless its time constant is more than about ten times the hold.
/// Without noise of the encoder and the converter, and without vibration, which move the axis by themselves.
///
/// None without a loop, without friction, and where the reference does not end.
std::optional<HuntingPrediction> predict_hunting(const trial::TrialParameters& trial);

/// For data each number, for people a sentence.
document::Description<HuntingPrediction> hunting_description();

}  // namespace zerocount::theory
