#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/loop/dac.hpp"
#include "core/trial/parameters.hpp"
#include "core/trial/torque_record.hpp"

namespace zerocount::trial {

/// Draws the torque levels (N m) of a random load history, in order. With u_k = open_uniform of number k of
/// the history's key: the first level lies upwards where u_0 ≥ ½ and downwards otherwise, and the direction
/// changes from level to level; level k = 1 … reversals is
///
///   l_k = l_{k−1} + u_k·(±torque − l_{k−1}),   l_0 = 0,
///
/// evenly distributed between the level before and the largest torque in its direction.
std::vector<double> draw_history(const RandomHistory& history, const random::TrialRandomness& randomness);

/// The open loop of a trial with torque levels or a recorded torque: the torque of each sample, as
/// SampledLoop gives it in a closed loop.
class OpenLoop {
 public:
  explicit OpenLoop(const TrialParameters& parameters) : p_(parameters), converter_(parameters.dac) {}

  /// Starts the next move, to the next torque level.
  /// @param number number of the move; moves come in order.
  void start_move(std::size_t number);

  struct Decision {
    /// Output of the converter; with TorquePath::exact, the torque as commanded with the code 0
    loop::DacOutput output;
    bool exact;  ///< Whether the torque bypasses the converter
    bool stays;  ///< Whether the same torque is decided at all later samples of the move
  };
  /// Decides the torque of a sample.
  /// @param i number of the sample from the start of the move.
  Decision decide(std::int64_t i);

  /// Time from the start of the move until the torque has reached its level, s.
  double travel_time() const;

 private:
  const TrialParameters& p_;
  loop::Converter converter_;
  TorqueRamp ramp_{};
};

}  // namespace zerocount::trial
