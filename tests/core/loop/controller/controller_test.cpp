// The control in two phases; its law is judged by judge_controller.py and the trials of
// widened_trial_test.cpp.
#include "core/loop/controller/controller.hpp"

#include "core/loop/controller/control_chain.hpp"
#include "core/loop/controller/count_difference.hpp"
#include "core/loop/controller/disturbance_observer.hpp"
#include "core/loop/controller/filter.hpp"
#include "core/loop/controller/pid.hpp"
#include "core/loop/controller/user_law.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/core/loop/test_blocks.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::loop {
namespace {

constexpr double lowest = -0.49;
constexpr double highest = 0.48;

TEST(Controller, StaysInTheCoarsePhaseWithADwellLongerThanAnyTrial) {
  for (const double time : {1e15, 1e17, 1e300}) {
    ControllerParameters p;
    p.coarse.coarse_beyond = 50.0;
    p.coarse.fine_dwell = time;
    Controller controller(p, {18.75}, 0.0, {{lowest, highest}});
    controller.update(0, {60, 3}, 0.0);
    for (int k = 0; k < 100; ++k) {
      controller.update(0, {0, 0}, 0.0);
      ASSERT_EQ(controller.phase(), ControlPhase::coarse);
    }
  }
}

// When the integral changes: deadband with hysteresis, zone, leak; and what the difference of counts is
// behind its filter.

constexpr TorqueRange any_torque{-1e9, 1e9};

/// [sample] the integral I after each of the errors, with a gain that adds 1 per count at each sample.
std::vector<double> integrals(const ControlBlocks& blocks, const std::vector<double>& errors) {
  Integrator integrator(integral_constants(blocks, 1000.0, any_torque), 0.0);
  std::vector<double> all;
  for (const double error : errors) all.push_back(integrator.add(error, 1.0));
  return all;
}

using Integrals = std::vector<double>;

TEST(Integrator, IsFrozenInsideTheDeadband) {
  EXPECT_EQ(integrals({.deadband = {1, -1}}, {2, 1, -1, 0, -2, 2}), (Integrals{1, 1, 1, 1, 2, 3}));
  EXPECT_EQ(integrals({.deadband = {0, -1}}, {1, 0, 0, -1}), (Integrals{1, 1, 1, 2}));
  EXPECT_EQ(integrals({}, {0, 0, 5}), (Integrals{1, 2, 3}));
}

TEST(Integrator, LeavesTheDeadbandLaterThanItEntersIt) {
  const Integrals expected{1, 2, 2, 2, 2, 3, 4, 4};
  EXPECT_EQ(integrals({.deadband = {1, 2}}, {3, 2, 1, 2, -2, 3, 2, 0}), expected);
}

TEST(Integrator, ChangesOnlyWithinItsZone) {
  EXPECT_EQ(integrals({.integrator_zone = 2}, {3, 2, -2, -3, 0}), (Integrals{0, 1, 2, 2, 3}));
}

TEST(Integrator, LeaksToTheLevelOfItsIncrements) {
  ControlBlocks blocks;
  blocks.integrator_leak = 0.05;
  Integrator integrator(integral_constants(blocks, 1000.0, any_torque), 3.0);
  for (int k = 1; k <= 100; ++k)
    EXPECT_NEAR(integrator.add(1.0, 0.0), 3.0 * std::exp(-0.001 * k / 0.05), 1e-14);
  for (int k = 0; k < 5000; ++k) integrator.add(1.0, 1.0);
  EXPECT_NEAR(integrator.value(), 1.0 / -std::expm1(-0.001 / 0.05), 1e-9);
}

TEST(Integrator, RemembersTheDeadbandWhileAnotherLawDecides) {
  Integrator integrator(integral_constants({.deadband = {1, 3}}, 1000.0, any_torque), 0.0);
  integrator.observe(1.0);
  EXPECT_EQ(integrator.add(3.0, 1.0), 0.0);
  integrator.observe(4.0);
  EXPECT_EQ(integrator.add(3.0, 1.0), 1.0);
}

TEST(CountDifference, AnswersAStepWithAnExponential) {
  ControlBlocks blocks;
  blocks.derivative_cutoff = 30.0;
  const double a = std::exp(-2.0 * std::numbers::pi * 30.0 / 1000.0);
  CountDifference difference(derivative_pole(blocks, 1000.0));
  EXPECT_EQ(difference.step(7.0), 0.0);  // the count before the first is the first
  for (int k = 0; k < 50; ++k) EXPECT_NEAR(difference.step(17.0), 10.0 * (1.0 - a) * std::pow(a, k), 1e-14);
}

TEST(CountDifference, WithoutAFilterIsTheDifferenceBitForBit) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 100.0);
  CountDifference difference(derivative_pole({}, 1000.0));
  double last = normal(random);
  difference.step(last);
  for (int k = 0; k < 100; ++k) {
    const double count = normal(random);
    ASSERT_EQ(difference.step(count), count - last);
    last = count;
  }
}

// The counts before the first sample.

/// The encoder count of a motion at a constant velocity at sample k; n_0 is the count of the initial angle
/// θ₀.
double count_of_motion(const CountsBefore& motion, double k) {
  const double theta = motion.theta + k * motion.velocity * motion.sample_time;
  return std::floor(theta / motion.encoder.resolution + motion.encoder.phase);
}

CountsBefore random_motion(testing::Draws& draws) {
  CountsBefore motion;
  motion.encoder = {draws.log_uniform(1e-9, 1e-3), draws.uniform(0.0, 1.0)};
  motion.sample_time = draws.log_uniform(1e-5, 1e-2);
  motion.velocity =
      draws.sign() * draws.log_uniform(1e-2, 1e2) * motion.encoder.resolution / motion.sample_time;
  motion.theta = draws.uniform(-10.0, 10.0) * motion.encoder.resolution;
  return motion;
}

// A difference that begins in a uniform motion is the one that has always seen this motion.
TEST(CountDifference, ContinuesTheMotionBeforeTheFirstSample) {
  testing::Draws draws(12);
  for (int i = 0; i < 300; ++i) {
    const CountsBefore motion = random_motion(draws);
    const int window = static_cast<int>(draws.integer(1, 20));
    const double pole = draws.chance(0.5) ? 0.0 : draws.uniform(0.0, 0.99);
    CountDifference difference(pole, window, motion);
    CountDifference always(pole, window);
    for (int k = -3000; k < 0; ++k) always.step(count_of_motion(motion, k));
    for (int k = 0; k < 60; ++k) {
      // What is left of the counts before the first is less than one in the window.
      const double allowed = std::pow(pole, k + 1) / window + 1e-9 * std::abs(counts_per_sample(motion));
      const double count = count_of_motion(motion, k);
      ASSERT_NEAR(difference.step(count), always.step(count), allowed) << i << ", sample " << k;
    }
  }
}

TEST(CountDifference, StartsAtZeroForAnAxisAtRest) {
  CountDifference difference(0.5, 4, {.encoder = {1e-6, 0.3}, .theta = 7e-4});
  EXPECT_EQ(difference.step(-12345.0), 0.0);
  EXPECT_EQ(difference.step(-12345.0), 0.0);
}

// What a uniform motion without torque shows is below what the counts round.
TEST(DisturbanceObserver, SeesNoDisturbanceInAUniformMotion) {
  testing::Draws draws(13);
  for (int i = 0; i < 200; ++i) {
    ControllerParameters parameters;
    parameters.sample_rate = 1000.0;
    parameters.blocks.observer = {draws.log_uniform(1.0, 100.0), 1e-3};
    ControlStart start;
    start.velocity_before = random_motion(draws);
    start.velocity_before.sample_time = 1e-3;
    start.velocity_before.velocity = draws.sign() * 100.0 * start.velocity_before.encoder.resolution / 1e-3;
    start.velocity_resolution = start.velocity_before.encoder.resolution;
    DisturbanceObserver observer(parameters, start);
    const auto constants = observer_constants(parameters.blocks.observer, 1000.0, start.velocity_resolution);
    for (int k = 0; k < 200; ++k) {
      Feedback now;
      now.velocity_count = count_of_motion(start.velocity_before, k);
      // Three counts apart in the second difference, and not the hundred of the first one.
      ASSERT_LT(std::abs(observer.step(now, 0.0)), 4.0 * constants.acceleration) << i << ", sample " << k;
    }
  }
}

// The blocks of the controller: what they say of themselves as linear systems is what they do sample by
// sample.

struct Input {
  Feedback feedback;
  double torque;
};

/// The filter's output y_k = Σ bᵢ·x_{k−i} − Σ aᵢ·y_{k−i} for the input x.
std::vector<double> filtered(const TransferFunction& transfer, const std::vector<double>& x) {
  std::vector<double> y(x.size(), 0.0);
  for (std::size_t k = 0; k < x.size(); ++k) {
    for (std::size_t i = 0; i <= k && i < transfer.b.size(); ++i) y[k] += transfer.b[i] * x[k - i];
    for (std::size_t i = 1; i <= k && i < transfer.a.size(); ++i) y[k] -= transfer.a[i] * y[k - i];
  }
  return y;
}

/// Output of the chain of stages for these inputs. The torque that the first stage receives is that of the
/// inputs.
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
      case LoopSignal::velocity_count:
        return signal([](const Input& i) { return i.feedback.velocity_count; });
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

/// Random inputs that start from rest: all values of the first sample are zero.
std::vector<Input> random_inputs(std::mt19937_64& random, std::size_t samples) {
  std::normal_distribution<double> normal;
  std::vector<Input> inputs(1);
  while (inputs.size() < samples) {
    const double count = std::round(100.0 * normal(random));
    Feedback feedback{20.0 - count, count, 0.3 * normal(random)};
    feedback.velocity_count = std::round(100.0 * normal(random));
    inputs.push_back({feedback, 0.3 * normal(random)});
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

  /// Random controller parameters without deadband and zone, which have no linear form.
  ControllerParameters control() {
    ControllerParameters p;
    p.sample_rate = log_uniform(100.0, 1e5);
    p.kp = gain();
    p.ki = gain();
    p.kd = gain();
    ControlBlocks& b = p.blocks;
    if (chance(0.5)) b.structure = ControlStructure::cascade;
    b.cascade = {.kv = log_uniform(1.0, 1e3),
                 .kp = log_uniform(1e-2, 1.0),
                 .ki = chance(0.2) ? 0.0 : log_uniform(1e-2, 1e2),
                 .latency = static_cast<int>(random_() % 4)};
    if (chance(0.5)) b.derivative_window = 1 + static_cast<int>(random_() % 5);
    if (chance(0.5)) b.integrator_leak = log_uniform(1.0, 1e4) / p.sample_rate;
    if (chance(0.5)) b.derivative_cutoff = p.sample_rate * log_uniform(1e-3, 0.5);
    for (std::uint64_t i = random_() % 4; i > 0; --i) b.filters.push_back(filter(p.sample_rate));
    b.feedforward = {gain(), gain(), gain()};
    if (chance(0.7)) b.observer = {p.sample_rate * log_uniform(1e-3, 0.3), log_uniform(1e-5, 1e-1)};
    return p;
  }

  std::mt19937_64 random_;
};

constexpr ControlStart at_rest{
    .integral_range = {-1e9, 1e9}, .resolution = 3.9e-6, .velocity_resolution = 7.1e-6};

template <ControlBlock Block>
void expect_its_linear_form(RandomControl& random) {
  for (int i = 0; i < 100; ++i) {
    const ControllerParameters parameters = random.control();
    Block block(parameters, at_rest);
    const std::vector<Input> inputs = random_inputs(random.random_, 300);
    const std::vector<double> expected = output_of(block.linear(), inputs);
    double largest = 0.0;
    for (const double torque : expected) largest = std::max(largest, std::abs(torque));
    for (std::size_t k = 0; k < inputs.size(); ++k)
      ASSERT_NEAR(block.step(inputs[k].feedback, inputs[k].torque), expected[k], 1e-9 * largest) << k;
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

TEST(ControlChain, EveryBlockMatchesItsLinearForm) {
  EachBlock<ControlBlockChain::List>::expect_linear_forms();
  EachBlock<std::tuple<Pid, Cascade, LowPass>>::expect_linear_forms();
}

TEST(ControlChain, AnAddedBlockHasTheImpulseResponseOfItsTransferFunction) {
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
  for (const Input& input : random_inputs(random, 500))
    EXPECT_EQ(chain.step(input.feedback), filter.step(input.feedback, pid.step(input.feedback)));
}

// A chain that starts under a torque gives it as long as nothing moves.
TEST(ControlChain, HoldsTheTorqueUnderWhichItStarts) {
  RandomControl random(31);
  for (int i = 0; i < 200; ++i) {
    ControllerParameters parameters = random.control();
    parameters.blocks.feedforward = {};
    parameters.blocks.standstill = {};
    parameters.blocks.hold = {};
    parameters.blocks.integrator_leak = std::numeric_limits<double>::infinity();
    const bool has_gain = std::ranges::all_of(parameters.blocks.filters, [&](const Filter& filter) {
      const auto c = discretised(filter, parameters.sample_rate);
      return std::abs(c.b0 + c.b1 + c.b2) > 1e-3;
    });
    if (!has_gain) continue;
    ControlChain chain(parameters, at_rest);
    chain.take_over(0.7);
    for (int k = 0; k < 200; ++k) {
      Feedback now;
      now.torque_in_force = 0.7;
      now.count = now.velocity_count = 5.0;
      now.sample = k;
      ASSERT_NEAR(chain.step(now), 0.7, 1e-6) << i << ", sample " << k;
    }
  }
}

// The filters: their response at the frequencies that the definition fixes, their stability, and how they go
// on from a torque in force.

constexpr double filter_rate = 2000.0;

std::complex<double> response(const BiquadConstants<double>& c, double frequency) {
  const std::complex<double> z = std::polar(1.0, -2.0 * std::numbers::pi * frequency / filter_rate);
  return (c.b0 + c.b1 * z + c.b2 * z * z) / (1.0 + c.a1 * z + c.a2 * z * z);
}

/// The largest magnitude of the poles of the filter; the filter is stable if it is below 1.
double largest_pole(const BiquadConstants<double>& c) {
  const std::complex<double> root = std::sqrt(std::complex<double>(c.a1 * c.a1 - 4.0 * c.a2));
  return 0.5 * std::max(std::abs(-c.a1 + root), std::abs(-c.a1 - root));
}

void expect_near(std::complex<double> value, std::complex<double> expected) {
  EXPECT_NEAR(value.real(), expected.real(), 1e-9);
  EXPECT_NEAR(value.imag(), expected.imag(), 1e-9);
}

// Prewarped at its frequency a filter has there exactly the response of the continuous one, and so at 0 and
// at infinity, which goes to half the sample rate.
TEST(Filter, HasTheContinuousResponseAtItsFrequencyAtZeroAndAtHalfTheSampleRate) {
  using namespace std::complex_literals;
  for (const double f : {1.0, 30.0, 200.0, 900.0, 990.0}) {
    Filter filter{.kind = FilterKind::lowpass, .frequency = f, .damping = 0.3};
    const BiquadConstants<double> lowpass = discretised(filter, filter_rate);
    expect_near(response(lowpass, f), 1.0 / (0.6i));
    expect_near(response(lowpass, 0.0), 1.0);
    expect_near(response(lowpass, 0.5 * filter_rate), 0.0);
    filter.kind = FilterKind::notch;
    filter.depth = 0.05;
    const BiquadConstants<double> notch = discretised(filter, filter_rate);
    expect_near(response(notch, f), 0.05);
    expect_near(response(notch, 0.0), 1.0);
    expect_near(response(notch, 0.5 * filter_rate), 1.0);
    filter.kind = FilterKind::lead;
    filter.ratio = 4.0;
    const BiquadConstants<double> lead = discretised(filter, filter_rate);
    expect_near(response(lead, f), (1.0 + 2.0i) / (1.0 + 0.5i));
    expect_near(response(lead, 0.0), 1.0);
    expect_near(response(lead, 0.5 * filter_rate), 4.0);
    for (const BiquadConstants<double>& stable : {lowpass, notch, lead}) EXPECT_LT(largest_pole(stable), 1.0);
  }
}

// A biquad with the coefficients of a filter of 2 kHz, moved to another rate, is that filter of the other
// rate.
TEST(Filter, GivenCoefficientsAreConvertedToAnotherSampleRate) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    Filter filter{.kind = static_cast<FilterKind>(i % 3),
                  .frequency = 5.0 + 900.0 * unit(random),
                  .damping = 0.05 + unit(random),
                  .depth = unit(random),
                  .ratio = 1.5 + 8.0 * unit(random)};
    const double ratio = i % 2 == 0 ? 2.0 : 1.0 + 3.0 * unit(random);
    const BiquadConstants<double> here = discretised(filter, filter_rate);
    const Filter given{.kind = FilterKind::biquad, .b = {here.b0, here.b1, here.b2}, .a = {here.a1, here.a2}};
    const std::optional<Filter> moved = resampled(given, ratio);
    ASSERT_TRUE(moved);
    const BiquadConstants<double> there = discretised(filter, ratio * filter_rate);
    const double expected[] = {there.b0, there.b1, there.b2, there.a1, there.a2};
    const double found[] = {moved->b[0], moved->b[1], moved->b[2], moved->a[0], moved->a[1]};
    for (int k = 0; k < 5; ++k) EXPECT_NEAR(found[k], expected[k], 1e-8) << i << ' ' << k;
  }
}

TEST(Filter, PoleAtHalfTheSampleRateIsRejected) {
  EXPECT_FALSE(resampled({.kind = FilterKind::biquad, .b = {1.0, 0.0, 0.0}, .a = {1.0, 0.0}}, 2.0));
  const std::optional<Filter> gain = resampled({.kind = FilterKind::biquad, .b = {3.0, 0.0, 0.0}}, 2.0);
  ASSERT_TRUE(gain);
  EXPECT_EQ(gain->b, (std::array<double, 3>{3.0, 0.0, 0.0}));
}

// In the steady state that take_over makes, the chain decides the torque in force whatever its blocks, and
// goes on deciding it while nothing moves.
TEST(ControlChain, ContinuesFromThePresentTorque) {
  testing::RandomBlocks draw(5);
  for (int i = 0; i < 100; ++i) {
    ControllerParameters p;
    p.blocks = draw.blocks(testing::BlockKind::all, p.sample_rate);
    p.blocks.observer.bandwidth = 0.0;  // its estimate goes on to change
    p.blocks.integrator_leak = std::numeric_limits<double>::infinity();
    ControlChain chain(p, {0.0, {-1e9, 1e9}, 4e-6});
    for (int k = 0; k < 50; ++k) chain.observe({0.0, 12.0, draw.uniform(-0.1, 0.1)});
    const double torque = draw.uniform(-0.3, 0.3);
    chain.take_over(torque);
    for (int k = 0; k < 50; ++k) ASSERT_NEAR(chain.step({0.0, 12.0, torque}), torque, 1e-12) << i;
  }
}

TEST(ControlChain, WithAnObserverChangesPhaseWithoutATorqueStep) {
  ControllerParameters p;
  p.ki = 0.0;
  p.blocks.observer = {20.0, 5e-4};
  const ControlStart start{0.0, {-1e9, 1e9}, 4e-6};
  ControlChain chain(p, start);
  for (int k = 0; k < 5000; ++k) chain.observe({0.0, 12.0, 0.1});
  chain.take_over(0.1);  // at rest the estimate is −0.1, which the integral balances
  for (int k = 0; k < 50; ++k) ASSERT_NEAR(chain.step({0.0, 12.0, 0.1}), 0.1, 1e-12);
}

ControllerParameters parameters_with(std::function<plugin::StepFunction(const zerocount_setup&)> start) {
  plugin::ControllerPlugin plugin{.description = {"law", "1", "", {}}};
  plugin.start = std::move(start);
  ControllerParameters parameters;
  parameters.sample_rate = 4000.0;
  parameters.user.plugin = std::make_shared<const plugin::ControllerPlugin>(std::move(plugin));
  return parameters;
}

TEST(UserLaw, IsSetUpOnceAndCalledForEverySample) {
  std::vector<std::int64_t> samples;
  const ControllerParameters parameters = parameters_with([&](const zerocount_setup& setup) {
    EXPECT_EQ(setup.sample_time, 1.0 / 4000.0);
    EXPECT_EQ(setup.resolution, 1e-6);
    EXPECT_EQ(setup.torque_resolution, 1e-4);
    EXPECT_EQ(setup.lowest_torque, -2.0);
    EXPECT_EQ(setup.highest_torque, 3.0);
    EXPECT_EQ(setup.initial_integral, 0.25);
    return [&, gain = setup.resolution](const zerocount_sample& sample) {
      samples.push_back(sample.k);
      EXPECT_EQ(sample.time, static_cast<double>(sample.k) / 4000.0);
      return gain * sample.error;
    };
  });
  const ControlStart start{.integral = 0.25, .resolution = 1e-6, .dac = {{-2.0, 3.0}, 1e-4}};
  UserLaw law(parameters, start);
  UserLaw moved = std::move(law);
  EXPECT_EQ(moved.step({.error = 3.0}, 0.0), 3e-6);
  EXPECT_EQ(moved.step({.error = -2.0}, 0.0), -2e-6);
  EXPECT_EQ(samples, (std::vector<std::int64_t>{0, 1}));
}

TEST(UserLaw, AnExceptionIsPassedToTheCaller) {
  const ControllerParameters parameters = parameters_with([](const zerocount_setup&) {
    return [](const zerocount_sample&) -> double { throw std::runtime_error("mine"); };
  });
  UserLaw law(parameters, {});
  EXPECT_THROW(law.step({}, 0.0), std::runtime_error);
}

}  // namespace
}  // namespace zerocount::loop
