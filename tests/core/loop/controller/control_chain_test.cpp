// The blocks of the controller: what they say of themselves as linear systems is what they do sample by
// sample.
#include "core/loop/controller/control_chain.hpp"

#include "tests/core/loop/test_blocks.hpp"
#include "tests/support/test.hpp"

namespace zerocount::loop {
namespace {

struct Input {
  Feedback feedback;
  double torque;
};

/// What comes of the signal by y_k = Σ bᵢ·x_{k−i} − Σ aᵢ·y_{k−i}.
std::vector<double> filtered(const TransferFunction& transfer, const std::vector<double>& x) {
  std::vector<double> y(x.size(), 0.0);
  for (std::size_t k = 0; k < x.size(); ++k) {
    for (std::size_t i = 0; i <= k && i < transfer.b.size(); ++i) y[k] += transfer.b[i] * x[k - i];
    for (std::size_t i = 1; i <= k && i < transfer.a.size(); ++i) y[k] -= transfer.a[i] * y[k - i];
  }
  return y;
}

/// The stages on the inputs' signals; that of the first one's torque is the inputs'.
std::vector<double> output_of(const LinearChain& stages, const std::vector<Input>& inputs) {
  const auto signal = [&](double (*of)(const Input&)) {
    std::vector<double> values;
    for (const Input& input : inputs) values.push_back(of(input));
    return values;
  };
  std::vector<double> torque = signal([](const Input& i) { return i.torque; });
  const auto input_of = [&](LoopSignal from) {
    switch (from) {
      case LoopSignal::torque:
        return torque;
      case LoopSignal::error:
        return signal([](const Input& i) { return i.feedback.error; });
      case LoopSignal::count:
        return signal([](const Input& i) { return i.feedback.count; });
      case LoopSignal::torque_in_force:
        break;
    }
    return signal([](const Input& i) { return i.feedback.torque_in_force; });
  };
  for (const LinearBlock& stage : stages) {
    std::vector<double> output(inputs.size(), 0.0);
    for (const SignalPath& path : stage) {
      const std::vector<double> part = filtered(path.transfer, input_of(path.from));
      for (std::size_t k = 0; k < output.size(); ++k) output[k] += part[k];
    }
    torque = output;
  }
  return torque;
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

class RandomControl {
 public:
  explicit RandomControl(unsigned seed) : random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0.0, 1.0)); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  double gain() { return chance(0.2) ? 0.0 : log_uniform(1e-6, 1e-2); }

  Filter filter(double sample_rate) {
    Filter filter;
    filter.kind = static_cast<FilterKind>(random_() % 4);
    filter.frequency = sample_rate * log_uniform(1e-3, 0.49);
    filter.damping = log_uniform(0.1, 2.0);
    filter.depth = uniform(0.0, 1.0);
    filter.ratio = log_uniform(0.2, 10.0);
    filter.b = {uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0)};
    filter.a[1] = uniform(-0.9, 0.9);
    filter.a[0] = uniform(-0.95, 0.95) * (1.0 + filter.a[1]);
    return filter;
  }

  /// Without deadband and zone, which have no linear form.
  ControllerParameters control() {
    ControllerParameters p;
    p.sample_rate = log_uniform(100.0, 1e5);
    p.kp = gain();
    p.ki = gain();
    p.kd = gain();
    ControlBlocks& b = p.blocks;
    if (chance(0.5)) b.structure = ControlStructure::cascade;
    b.cascade = {log_uniform(1.0, 1e3), log_uniform(1e-2, 1.0), chance(0.2) ? 0.0 : log_uniform(1e-2, 1e2)};
    if (chance(0.5)) b.integrator_leak = log_uniform(1.0, 1e4) / p.sample_rate;
    if (chance(0.5)) b.derivative_cutoff = p.sample_rate * log_uniform(1e-3, 0.5);
    for (std::uint64_t i = random_() % 4; i > 0; --i) b.filters.push_back(filter(p.sample_rate));
    b.feedforward = {gain(), gain(), gain()};
    if (chance(0.7)) b.observer = {p.sample_rate * log_uniform(1e-3, 0.3), log_uniform(1e-5, 1e-1)};
    return p;
  }

  std::mt19937_64 random_;
};

constexpr ControlStart at_rest{0.0, {-1e9, 1e9}, 3.9e-6};

template <ControlBlock Block>
void expect_its_linear_form(RandomControl& random) {
  for (int i = 0; i < 100; ++i) {
    const ControllerParameters parameters = random.control();
    Block block(parameters, at_rest);
    const std::vector<Input> inputs = random_inputs(random.random_, 300);
    const std::vector<double> expected = output_of(block.linear(), inputs);
    double largest = 0.0;
    for (const double torque : expected) largest = std::max(largest, std::abs(torque));
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      ASSERT_NEAR(block.step(inputs[k].feedback, inputs[k].torque), expected[k], 1e-9 * largest) << k;
    }
  }
}

template <class List>
struct EachBlock;
template <class... Blocks>
struct EachBlock<std::tuple<Blocks...>> {
  static void expect_linear_forms() {
    RandomControl random(17);
    (expect_its_linear_form<Blocks>(random), ...);
  }
};

TEST(ControlChain, TheLinearFormOfEveryBlockIsWhatItDoes) {
  EachBlock<ControlBlockChain::List>::expect_linear_forms();
  EachBlock<std::tuple<Pid, Cascade, LowPass>>::expect_linear_forms();
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
