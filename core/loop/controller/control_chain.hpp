#pragma once

#include <cstddef>
#include <tuple>

#include "core/loop/controller/control_block.hpp"
#include "core/loop/controller/control_law.hpp"
#include "core/loop/controller/disturbance_observer.hpp"
#include "core/loop/controller/feedforward.hpp"
#include "core/loop/controller/filter.hpp"
#include "core/loop/controller/torque_hold.hpp"

namespace zerocount::loop {

/// Controller blocks in series, from the encoder feedback to the wanted torque.
template <ControlBlock... Blocks>
class BlockChain {
 public:
  using List = std::tuple<Blocks...>;

  BlockChain(const ControllerParameters& parameters, const ControlStart& start)
      : blocks_(Blocks(parameters, start)...) {}

  /// Runs all blocks for this sample.
  /// @returns the wanted torque (N m).
  double step(const Feedback& now) {
    double torque = 0.0;
    for_each([&](auto& block) { torque = block.step(now, torque); });
    return torque;
  }
  /// Updates the blocks at a sample at which another chain (of the other control phase) decides the torque.
  void observe(const Feedback& now) {
    for_each([&](auto& block) { block.observe(now); });
  }
  /// Updates the blocks at a sample at which the torque is held.
  void pause(const Feedback& now) {
    for_each([&](auto& block) { block.pause(now); });
  }
  /// Sets the states of the blocks so that the next sample, which may be the first, continues from this
  /// torque in force (N m). From the last block to the first, each block returns the torque that it needs
  /// from the block before.
  void take_over(double torque) { take_over_by<sizeof...(Blocks)>(torque); }

  LinearChain linear() const {
    LinearChain chain;
    const auto append = [&](const LinearChain& stages) {
      chain.insert(chain.end(), stages.begin(), stages.end());
    };
    std::apply([&](const auto&... block) { (append(block.linear()), ...); }, blocks_);
    return chain;
  }

  template <class Block>
  const Block& block() const {
    return std::get<Block>(blocks_);
  }

 private:
  template <class Visit>
  void for_each(Visit visit) {
    std::apply([&](auto&... block) { (visit(block), ...); }, blocks_);
  }

  /// Passes the torque (N m) to the first `count` blocks, from the last to the first; each sets its state and
  /// returns the torque that it needs from the block before.
  template <std::size_t count>
  void take_over_by(double torque) {
    if constexpr (count > 0) take_over_by<count - 1>(std::get<count - 1>(blocks_).take_over(torque));
  }

  List blocks_;
};

/// The blocks of the controller, in the order in which they act.
using ControlBlockChain = BlockChain<ControlLaw, Filters, Feedforward, DisturbanceObserver>;

/// The controller's blocks in series (ControlBlockChain), with a hold of their torque at standstill.
class ControlChain {
 public:
  ControlChain(const ControllerParameters& parameters, const ControlStart& start)
      : blocks_(parameters, start), hold_(parameters, start) {}

  /// Runs the blocks and the torque hold for this sample.
  /// @returns the wanted torque (N m).
  double step(const Feedback& now) {
    if (hold_.holds(now)) {
      blocks_.pause(now);
    } else {
      hold_.remember(blocks_.step(now));
    }
    return hold_.torque();
  }
  /// Updates the blocks at a sample at which another chain (of the other control phase) decides the torque.
  void observe(const Feedback& now) {
    blocks_.observe(now);
    hold_.restart();
  }
  /// Sets the states of the blocks so that the next sample continues from this torque in force (N m).
  void take_over(double torque) { blocks_.take_over(torque); }
  /// Linear descriptions of the blocks' stages, without their limits, while the torque is not held.
  LinearChain linear() const { return blocks_.linear(); }
  /// Integral I of the control law, N m
  double integral() const { return blocks_.block<ControlLaw>().integral(); }

 private:
  ControlBlockChain blocks_;
  TorqueHold hold_;
};

}  // namespace zerocount::loop
