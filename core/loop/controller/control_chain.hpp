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

/// Blocks one after the other, from the feedback to the wanted torque.
template <ControlBlock... Blocks>
class BlockChain {
 public:
  using List = std::tuple<Blocks...>;

  BlockChain(const ControllerParameters& parameters, const ControlStart& start)
      : blocks_(Blocks(parameters, start)...) {}

  /// The wanted torque (N m) at this sample.
  double step(const Feedback& now) {
    double torque = 0.0;
    for_each([&](auto& block) { torque = block.step(now, torque); });
    return torque;
  }
  /// A sample at which another chain decides.
  void observe(const Feedback& now) {
    for_each([&](auto& block) { block.observe(now); });
  }
  /// A sample at which the torque is held.
  void pause(const Feedback& now) {
    for_each([&](auto& block) { block.pause(now); });
  }
  /// Prepares the blocks so that the next sample, which may be the first, continues from this torque in force
  /// (N m). From the last block to the first, each block returns the torque that it needs from the block
  /// before.
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

  /// Hands the torque over to the first `count` blocks, from the last to the first.
  template <std::size_t count>
  void take_over_by(double torque) {
    if constexpr (count > 0) take_over_by<count - 1>(std::get<count - 1>(blocks_).take_over(torque));
  }

  List blocks_;
};

/// The blocks of the controller, in order.
using ControlBlockChain = BlockChain<ControlLaw, Filters, Feedforward, DisturbanceObserver>;

/// The controller's blocks (ControlBlockChain), with a hold of their torque.
class ControlChain {
 public:
  ControlChain(const ControllerParameters& parameters, const ControlStart& start)
      : blocks_(parameters, start), hold_(parameters, start) {}

  /// The wanted torque (N m) at this sample.
  double step(const Feedback& now) {
    if (hold_.holds(now)) {
      blocks_.pause(now);
    } else {
      hold_.remember(blocks_.step(now));
    }
    return hold_.torque();
  }
  /// A sample at which another chain decides.
  void observe(const Feedback& now) {
    blocks_.observe(now);
    hold_.restart();
  }
  /// The next sample continues from this torque in force (N m).
  void take_over(double torque) { blocks_.take_over(torque); }
  /// Stages away from their limits, while the torque is not held.
  LinearChain linear() const { return blocks_.linear(); }
  double integral() const { return blocks_.block<ControlLaw>().integral(); }  ///< I, N m

 private:
  ControlBlockChain blocks_;
  TorqueHold hold_;
};

}  // namespace zerocount::loop
