// The blocks of the controller: what they say of themselves as linear systems is what they do sample by
// sample.
#include "core/loop/control_chain.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/loop/test_blocks.hpp"

namespace zerocount::loop {
namespace {

struct Input {
  Feedback feedback;
  double torque;
};

double signal_of(const Input& input, LoopSignal from) {
  switch (from) {
    case LoopSignal::torque:
      return input.torque;
    case LoopSignal::error:
      return input.feedback.error;
    case LoopSignal::count:
      return input.feedback.count;
    case LoopSignal::torque_in_force:
      break;
  }
  return input.feedback.torque_in_force;
}

/// What comes of the signal by y_k = Σ bᵢ·x_{k−i} − Σ aᵢ·y_{k−i}.
std::vector<double> filtered(const TransferFunction& transfer, const std::vector<double>& x) {
  std::vector<double> y(x.size(), 0.0);
  for (std::size_t k = 0; k < x.size(); ++k) {
    for (std::size_t i = 0; i <= k && i < transfer.b.size(); ++i) y[k] += transfer.b[i] * x[k - i];
    for (std::size_t i = 1; i <= k && i < transfer.a.size(); ++i) y[k] -= transfer.a[i] * y[k - i];
  }
  return y;
}

std::vector<double> output_of(const LinearBlock& block, const std::vector<Input>& inputs) {
  std::vector<double> output(inputs.size(), 0.0);
  for (const SignalPath& path : block) {
    std::vector<double> signal;
    for (const Input& input : inputs) signal.push_back(signal_of(input, path.from));
    const std::vector<double> part = filtered(path.transfer, signal);
    for (std::size_t k = 0; k < output.size(); ++k) output[k] += part[k];
  }
  return output;
}

/// From rest: the first sample is zero throughout.
std::vector<Input> random_inputs(std::mt19937_64& random, std::size_t samples) {
  std::normal_distribution<double> normal;
  std::vector<Input> inputs(1);
  while (inputs.size() < samples) {
    const double count = std::round(100.0 * normal(random));
    inputs.push_back({{20.0 - count, count, 0.3 * normal(random)}, 0.3 * normal(random)});
  }
  return inputs;
}

template <ControlBlock Block>
void expect_its_linear_form(std::mt19937_64& random) {
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const auto gain = [&] { return part(random) < 0.2 ? 0.0 : 1e-6 * std::pow(1e4, part(random)); };
  constexpr TorqueRange wide{-1e9, 1e9};
  for (int i = 0; i < 100; ++i) {
    ControllerParameters parameters;
    parameters.kp = gain();
    parameters.ki = gain();
    parameters.kd = gain();
    Block block(parameters, {0.0, wide});
    const std::vector<Input> inputs = random_inputs(random, 300);
    const std::vector<double> expected = output_of(block.linear(), inputs);
    double largest = 0.0;
    for (const double torque : expected) largest = std::max(largest, std::abs(torque));
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      ASSERT_NEAR(block.step(inputs[k].feedback, inputs[k].torque), expected[k], 1e-12 * largest) << k;
    }
  }
}

template <class List>
struct EachBlock;
template <class... Blocks>
struct EachBlock<std::tuple<Blocks...>> {
  static void expect_linear_forms() {
    std::mt19937_64 random(17);
    (expect_its_linear_form<Blocks>(random), ...);
  }
};

TEST(ControlChain, TheLinearFormOfEveryBlockIsWhatItDoes) {
  EachBlock<ControlChain::List>::expect_linear_forms();
  EachBlock<std::tuple<LowPass>>::expect_linear_forms();
}

TEST(ControlChain, ABlockOfTheTestsHasTheImpulseResponseOfItsTransferFunction) {
  LowPass block({}, {});
  for (int k = 0; k < 50; ++k) {
    EXPECT_NEAR(block.step({}, k == 0 ? 1.0 : 0.0), (1.0 - LowPass::decay) * std::pow(LowPass::decay, k),
                1e-15);
  }
}

TEST(ControlChain, BlocksActOneAfterTheOther) {
  const ControllerParameters parameters{.kp = 2e-3, .ki = 1e-4, .kd = 5e-3};
  const ControlStart start{0.01, {-0.4, 0.4}};
  BlockChain<Pid, LowPass> chain(parameters, start);
  Pid pid(parameters, start);
  LowPass filter(parameters, start);
  std::mt19937_64 random(18);
  for (const Input& input : random_inputs(random, 500)) {
    EXPECT_EQ(chain.step(input.feedback), filter.step(input.feedback, pid.step(input.feedback)));
  }
}

}  // namespace
}  // namespace zerocount::loop
