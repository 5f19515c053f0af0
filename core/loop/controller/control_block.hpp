#pragma once

#include <concepts>
#include <cstdint>
#include <vector>

#include "core/loop/encoder.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::loop {

/// Transfer function of a sampled linear system, H(z) = (b₀ + b₁·z⁻¹ + …)/(1 + a₁·z⁻¹ + …).
struct TransferFunction {
  std::vector<double> b;       ///< Numerator coefficients b₀, b₁, …
  std::vector<double> a{1.0};  ///< Denominator coefficients 1, a₁, …
};

/// Input signal of a stage of the controller at sample k, in the linear description of the loop.
enum class LoopSignal {
  torque,          ///< Output of the stage before, N m (rad/s within the cascade); 0 for the first stage
  error,           ///< Control error e_k, reference minus count, counts
  count,           ///< Count of the encoder that closes the loop
  velocity_count,  ///< Count of the encoder that a cascade's velocity loop reads; without a cascade: `count`
  torque_in_force  ///< Torque that was decided at sample k − 1, N m
};

/// Path from one of the inputs of a controller stage to its output: an input signal and a transfer function.
struct SignalPath {
  LoopSignal from;
  TransferFunction transfer;
};

/// Linear description of a controller stage, without saturation and other limits: its output is the sum of
/// its paths.
using LinearBlock = std::vector<SignalPath>;

/// Linear descriptions of the stages of a controller block, or of all blocks of a controller, in order.
using LinearChain = std::vector<LinearBlock>;

/// Lowest and highest value of a torque, N m.
struct TorqueRange {
  double lowest{0.0};
  double highest{0.0};
};

/// Motion of the reference, before it is rounded to counts, at a sampling instant.
struct ReferenceMotion {
  double velocity{0.0};      ///< Velocity ṙ of the reference, rad/s
  double acceleration{0.0};  ///< Acceleration r̈ of the reference, rad/s²
  double position{0.0};      ///< Position r of the reference, counts
};

/// Inputs of the controller at a sampling instant. Error and count are in counts of the fine encoder; they
/// are whole numbers unless a coarser encoder closes the loop. velocity_count and other_count are in the
/// counts of their own encoders.
struct Feedback {
  double error{0.0};            ///< Control error: reference minus count, counts
  double count{0.0};            ///< Count of the encoder that closes the loop, counts
  double torque_in_force{0.0};  ///< Torque decided at the last sample, N m; 0 before the first sample
  ReferenceMotion reference{};
  bool new_target{false};  ///< Whether the target differs from that of the last sample
  std::int64_t sample{0};  ///< Number of the sample, counted from the start of the trial
  /// Count of the encoder that a cascade's velocity loop reads; without a cascade equal to `count`
  double velocity_count{0.0};
  double other_count{0.0};  ///< Count of the encoder on the other mass; 0 without it
};

/// Torque range and resolution of the digital-to-analogue converter, as far as the controller uses them.
struct DacScale {
  TorqueRange range{};     ///< Range to which anti-windup clamps the integral, N m
  double resolution{0.0};  ///< Torque Δu of one code, N m
};

/// State and encoders of the controller before its first sample.
struct ControlStart {
  double integral{0.0};  ///< Integral I of the control law, N m
  TorqueRange integral_range{};
  double resolution{1.0};  ///< Resolution Δx of the encoder that closes the loop, rad per count
  DacScale dac{};
  double velocity_resolution{1.0};  ///< Resolution Δx of the encoder that a cascade's velocity loop reads,
                                    ///< rad per count
  double other_resolution{0.0};     ///< Δx of the encoder of other_count, rad per count; 0 without it
  CountsBefore before{};            ///< Counts of the encoder that closes the loop before the first sample
  CountsBefore velocity_before{};   ///< Counts of the velocity loop's encoder before the first sample
};

/// Requirements on a block of the controller (README.md): it is constructed from its parameters, keeps its
/// state, and computes its output from sample to sample.
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
