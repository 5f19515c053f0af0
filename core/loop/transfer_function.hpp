#pragma once

#include <vector>

namespace zerocount::loop {

/// H(z) = (b₀ + b₁·z⁻¹ + …)/(1 + a₁·z⁻¹ + …).
struct TransferFunction {
  std::vector<double> b;       ///< b₀, b₁, …
  std::vector<double> a{1.0};  ///< 1, a₁, …
};

/// Input signal of a block of the controller at sample k.
enum class LoopSignal {
  torque,          ///< from the block before it, N m; 0 for the first
  error,           ///< e_k, counts
  count,           ///< counts
  torque_in_force  ///< decided at sample k − 1, N m
};

/// From one of a block's inputs to its output.
struct SignalPath {
  LoopSignal from;
  TransferFunction transfer;
};

/// A block away from its limits: its output is the sum of its paths.
using LinearBlock = std::vector<SignalPath>;

/// The blocks of a controller, in order.
using LinearChain = std::vector<LinearBlock>;

}  // namespace zerocount::loop
