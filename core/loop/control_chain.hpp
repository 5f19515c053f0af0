#pragma once

#include <tuple>

#include "core/loop/control_block.hpp"
#include "core/loop/pid.hpp"

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
  /// The next sample goes on from this torque in force (N m).
  void take_over(double torque) {
    for_each([&](auto& block) { block.take_over(torque); });
  }

  LinearChain linear() const {
    return std::apply([](const auto&... block) { return LinearChain{block.linear()...}; }, blocks_);
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

  List blocks_;
};

/// The blocks of the controller, in order.
using ControlChain = BlockChain<Pid>;

}  // namespace zerocount::loop
