#pragma once

#include <vector>

namespace zerocount::loop {

/// H(z) = (b₀ + b₁·z⁻¹ + …)/(1 + a₁·z⁻¹ + …).
struct TransferFunction {
  std::vector<double> b;       ///< b₀, b₁, …
  std::vector<double> a{1.0};  ///< 1, a₁, …
};

/// Input signal of a stage of the controller at sample k.
enum class LoopSignal {
  torque,          ///< from the stage before it, N m (rad/s within the cascade); 0 for the first
  error,           ///< e_k, counts
  count,           ///< counts
  velocity_count,  ///< of the encoder that the velocity loop of a cascade reads, counts of it; else `count`
  torque_in_force  ///< decided at sample k − 1, N m
};

/// From one of a stage's inputs to its output.
struct SignalPath {
  LoopSignal from;
  TransferFunction transfer;
};

/// A stage of the controller away from its limits: its output is the sum of its paths.
using LinearBlock = std::vector<SignalPath>;

/// The stages of a block, or of all blocks of a controller, in order.
using LinearChain = std::vector<LinearBlock>;

}  // namespace zerocount::loop
