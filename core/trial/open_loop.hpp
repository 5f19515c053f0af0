#pragma once

#include <cstddef>
#include <cstdint>

#include "core/loop/dac.hpp"
#include "core/trial/parameters.hpp"
#include "core/trial/torque_ramp.hpp"

namespace zerocount::trial {

/// The open loop of a trial with torque levels or a recorded torque: the torque of each sample, as
/// SampledLoop gives it in a closed loop.
class OpenLoop {
 public:
  explicit OpenLoop(const TrialParameters& parameters) : p_(parameters), converter_(parameters.dac) {}

  /// @param number of the move; moves come in order.
  void start_move(std::size_t number);

  struct Decision {
    loop::DacOutput output;  ///< with TorquePath::exact the torque as commanded, and the code 0
    bool exact;              ///< the torque passes the converter
    bool stays;              ///< the same is decided at all later samples of the move
  };
  /// @param i number of the sample from the start of the move.
  Decision decide(std::int64_t i);

  /// Time until the torque is at the level of the move, s.
  double travel_time() const;

 private:
  const TrialParameters& p_;
  loop::Converter converter_;
  TorqueRamp ramp_{};
};

}  // namespace zerocount::trial
