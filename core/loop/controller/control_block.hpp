#pragma once

#include <concepts>
#include <cstdint>
#include <vector>

#include "core/loop/encoder.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::loop {

/// Transfer function H(z) = (b₀ + b₁·z⁻¹ + …)/(1 + a₁·z⁻¹ + …).
struct TransferFunction {
  std::vector<double> b;       ///< Numerator coefficients b₀, b₁, …
  std::vector<double> a{1.0};  ///< Denominator coefficients 1, a₁, …
};

/// Input signal of a stage of the controller at sample k.
enum class LoopSignal {
  torque,          ///< Output of the stage before, N m (rad/s within the cascade); 0 for the first stage
  error,           ///< Error e_k, counts
  count,           ///< Count of the encoder that closes the loop
  velocity_count,  ///< Count of the encoder that a cascade's velocity loop reads; without a cascade: `count`
  torque_in_force  ///< Torque decided at sample k − 1, N m
};

/// Path from one of a stage's inputs to its output.
struct SignalPath {
  LoopSignal from;
  TransferFunction transfer;
};

/// A stage of the controller away from its limits: its output is the sum of its paths.
using LinearBlock = std::vector<SignalPath>;

/// The stages of a block, or of all blocks of a controller, in order.
using LinearChain = std::vector<LinearBlock>;

/// Bounds of a torque, N m.
struct TorqueRange {
  double lowest{0.0};
  double highest{0.0};
};

/// Motion of the unrounded reference at a sampling instant.
struct ReferenceMotion {
  double velocity{0.0};      ///< ṙ, rad/s
  double acceleration{0.0};  ///< r̈, rad/s²
  double position{0.0};      ///< r, counts
};

/// Inputs of the controller at a sampling instant. Error and count are in counts of the fine encoder; they
/// are whole numbers unless a coarser encoder closes the loop. velocity_count and other_count are in counts
/// of their own encoders.
struct Feedback {
  double error{0.0};            ///< Reference − count, counts
  double count{0.0};            ///< counts
  double torque_in_force{0.0};  ///< Torque decided at the last sample, N m; 0 before the first
  ReferenceMotion reference{};
  bool new_target{false};  ///< The target differs from that of the last sample.
  std::int64_t sample{0};  ///< Number of the sample from the start of the trial
  /// Count of the encoder that a cascade's velocity loop reads; otherwise `count`
  double velocity_count{0.0};
  double other_count{0.0};  ///< Count of the encoder on the other mass; 0 without it
};

/// Range and resolution of the converter.
struct DacScale {
  TorqueRange range{};     ///< Range to which anti-windup clamps the integral.
  double resolution{0.0};  ///< Δu, N m
};

/// The controller before its first sample.
struct ControlStart {
  double integral{0.0};  ///< I, N m
  TorqueRange integral_range{};
  double resolution{1.0};  ///< Δx, rad per count
  DacScale dac{};
  double velocity_resolution{1.0};  ///< Δx of the encoder of velocity_count, rad per count
  double other_resolution{0.0};     ///< Δx of the encoder of other_count, rad per count; 0 without it
  CountsBefore before{};            ///< counts before the first sample
  CountsBefore velocity_before{};   ///< velocity_counts before the first sample
};

/// A block of the controller (README.md): its parameters, its state, and its law from sample to sample.
template <class Block>
concept ControlBlock = std::constructible_from<Block, const ControllerParameters&, const ControlStart&> &&
    requires(Block block, const Block now, const Feedback& feedback, double torque) {
  { block.step(feedback, torque) } -> std::same_as<double>;  // the torque (N m) from that of the block before
  block.observe(feedback);  // updates the memory at a sample at which another chain decides
  block.pause(feedback);    // at a sample at which the torque is held
  // The next step is to go on from this torque (N m). Gives the torque that it needs from the block before.
  { block.take_over(torque) } -> std::same_as<double>;
  { now.linear() } -> std::same_as<LinearChain>;  // its stages, away from its limits; none: it is transparent
};

}  // namespace zerocount::loop
