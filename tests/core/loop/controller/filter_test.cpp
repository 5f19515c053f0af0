// The filters: their response at the frequencies that the definition fixes, their stability, and how they go
// on from a torque in force.
#include "core/loop/controller/filter.hpp"

#include "core/loop/controller/control_chain.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/test.hpp"

namespace zerocount::loop {
namespace {

constexpr double filter_rate = 2000.0;

std::complex<double> response(const BiquadConstants<double>& c, double frequency) {
  const std::complex<double> z = std::polar(1.0, -2.0 * std::numbers::pi * frequency / filter_rate);
  return (c.b0 + c.b1 * z + c.b2 * z * z) / (1.0 + c.a1 * z + c.a2 * z * z);
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
    EXPECT_TRUE(is_stable(lowpass) && is_stable(notch) && is_stable(lead));
  }
}

// A biquad with the coefficients of a filter of 2 kHz, moved to another rate, is that filter of the other
// rate.
TEST(Filter, OfCoefficientsMovesToAnotherSampleRateAsTheFilterThatTheyAreOf) {
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

TEST(Filter, OfCoefficientsWithAPoleAtHalfTheSampleRateIsOfNoOtherRate) {
  EXPECT_FALSE(resampled({.kind = FilterKind::biquad, .b = {1.0, 0.0, 0.0}, .a = {1.0, 0.0}}, 2.0));
  const std::optional<Filter> gain = resampled({.kind = FilterKind::biquad, .b = {3.0, 0.0, 0.0}}, 2.0);
  ASSERT_TRUE(gain);
  EXPECT_EQ(gain->b, (std::array<double, 3>{3.0, 0.0, 0.0}));
}

TEST(Filter, IsStableWhereBothPolesLieInsideTheUnitCircle) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coefficient(-2.5, 2.5);
  for (int i = 0; i < 2000; ++i) {
    const double a1 = coefficient(random);
    const double a2 = coefficient(random);
    const std::complex<double> root = std::sqrt(std::complex<double>(a1 * a1 - 4.0 * a2));
    const double radius = 0.5 * std::max(std::abs(-a1 + root), std::abs(-a1 - root));
    EXPECT_EQ(is_stable({1, 0, 0, a1, a2}), radius < 1.0) << a1 << " " << a2;
  }
}

// In the steady state that take_over makes, the chain decides the torque in force whatever its blocks, and
// goes on deciding it while nothing moves.
TEST(ControlChain, GoesOnFromTheTorqueInForce) {
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

TEST(ControlChain, WithAnObserverChangesTheTorqueOnlyAsTheEstimateGoesOn) {
  ControllerParameters p;
  p.ki = 0.0;
  p.blocks.observer = {20.0, 5e-4};
  const ControlStart start{0.0, {-1e9, 1e9}, 4e-6};
  ControlChain chain(p, start);
  for (int k = 0; k < 5000; ++k) chain.observe({0.0, 12.0, 0.1});
  chain.take_over(0.1);  // at rest the estimate is −0.1, which the integral balances
  for (int k = 0; k < 50; ++k) ASSERT_NEAR(chain.step({0.0, 12.0, 0.1}), 0.1, 1e-12);
}

}  // namespace
}  // namespace zerocount::loop
