#pragma once

#include <cstdint>
#include <optional>

#include "analysis/basis/document/description.hpp"
#include "core/motion/parameters.hpp"
#include "core/trial/parameters.hpp"

/// Hunting, the lasting oscillation of a position loop with friction or a gap, as a trial of the loop shows
/// it.
namespace zerocount::theory {

enum class Hunting : std::uint8_t {
  rests,     ///< The axis comes to rest, wherever it stands, or stays within a range of two counts.
  hunts,     ///< The axis oscillates for good (limit cycle).
  diverges,  ///< The simulated motion becomes non-finite.
  undecided  ///< The simulation ends before the motion can be judged.
};

struct HuntingPrediction {
  Hunting state{Hunting::undecided};
  std::int64_t step{0};  ///< Length of the move, counts.
  /// If the axis hunts (oscillates for good): half of the range of the position, counts of the loop's
  /// encoder; otherwise 0.
  double amplitude{0.0};
  /// If the axis hunts (oscillates for good): period of the oscillation, s; otherwise 0.
  double period{0.0};
  double duration{0.0};  ///< Time that was simulated, from the start of the move, s.
  /// If the axis hunts (oscillates for good) and has two masses: the mass that oscillates. If both do: the
  /// mass whose encoder closes the loop.
  std::optional<motion::EncoderPlace> mass{};
};

/// Largest number of samples after the end of the reference's motion that are simulated.
inline constexpr std::int64_t max_samples_held = 1 << 20;
/// Largest number of integration steps of the plant that are simulated. A contact that creeps fast takes many
/// in each sample.
inline constexpr std::int64_t max_steps_held = 1 << 21;

/// Predicts whether a loop hunts (oscillates for good), from the longest move of the trial, simulated from
/// its start, without noise of encoders and converter and without vibration, which move the axis by
/// themselves:
///
///   simulate until the reference is at rest
///   for n = 2¹³, 2¹⁴ … max_samples_held samples from there on:
///     rests   if both masses stand in the last ¾ of them, and the wanted torque will not move them
///     hunts   if the position of a mass has a cycle that lasts
///
/// (lasting_motion.hpp). It ends undecided after max_samples_held samples or max_steps_held integration
/// steps: the answer does not depend on the speed of the computer.
///
/// Nothing for an open loop, a reference without end, and an axis with neither friction nor gap.
std::optional<HuntingPrediction> predict_hunting(const trial::TrialParameters& trial);

/// Output items of the prediction: for data each number, for people a sentence.
document::Description<HuntingPrediction> hunting_description();

}  // namespace zerocount::theory
