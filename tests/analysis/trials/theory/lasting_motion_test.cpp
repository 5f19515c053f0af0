// A cycle is told from a decay, a growth and a drift; a torque at rest from one that will move the axis.
#include "analysis/trials/theory/lasting_motion.hpp"

#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/test.hpp"

namespace zerocount::theory {
namespace {

constexpr std::size_t length = 1 << 13;

template <class Function>
std::vector<float> series(Function value_at) {
  std::vector<float> values(length);
  for (std::size_t k = 0; k < length; ++k) values[k] = static_cast<float>(value_at(static_cast<double>(k)));
  return values;
}

double wave(double k, double period) {
  return std::sin(2.0 * std::numbers::pi * k / period);
}

TEST(LastingMotion, HasTheAmplitudeAndThePeriodOfItsCycle) {
  testing::RandomBlocks draw(1);
  for (int i = 0; i < 50; ++i) {
    const double period = draw.log_uniform(10.0, 900.0);
    const double amplitude = draw.log_uniform(2.0, 1e6);
    const double middle = draw.uniform(-1e3, 1e3);
    const auto cycle = lasting_cycle(series([&](double k) { return middle + amplitude * wave(k, period); }));
    ASSERT_TRUE(cycle) << period;
    EXPECT_NEAR(cycle->amplitude, amplitude, 0.06 * amplitude);
    EXPECT_NEAR(cycle->period, period, 0.02 * period);
  }
}

// A ripple that is smaller than the cycle crosses its middle many times.
TEST(LastingMotion, ReadsNoPeriodFromASmallRipple) {
  const auto cycle =
      lasting_cycle(series([](double k) { return 100.0 * wave(k, 800.0) + 20.0 * wave(k, 7.0); }));
  ASSERT_TRUE(cycle);
  EXPECT_NEAR(cycle->period, 800.0, 10.0);
}

TEST(LastingMotion, MotionThatDecaysGrowsOrDriftsIsNotACycle) {
  testing::RandomBlocks draw(2);
  for (int i = 0; i < 50; ++i) {
    const double period = draw.log_uniform(10.0, 500.0);
    const double time = static_cast<double>(length) * draw.log_uniform(0.3, 20.0);
    const auto of = [&](auto envelope) {
      return lasting_cycle(series([&](double k) { return 1000.0 * envelope(k) * wave(k, period); }))
          .has_value();
    };
    EXPECT_FALSE(of([&](double k) { return std::exp(-k / time); })) << period << " " << time;
    EXPECT_FALSE(of([&](double k) { return std::exp(k / time); })) << period << " " << time;
    EXPECT_FALSE(of([](double k) { return 1.0 / (1.0 + std::sqrt(k)); })) << period;
    EXPECT_FALSE(lasting_cycle(series([&](double k) { return 10.0 * wave(k, period) + 0.02 * k; })));
  }
}

// As an oscillator does that is started with too much.
TEST(LastingMotion, IsACycleOnceItsTransientHasDecayed) {
  const auto amplitude = [](double k, double time) { return 1000.0 * (1.0 + 9.0 * std::exp(-k / time)); };
  EXPECT_TRUE(lasting_cycle(series([&](double k) { return amplitude(k, 300.0) * wave(k, 100.0); })));
  EXPECT_FALSE(lasting_cycle(series([&](double k) { return amplitude(k, 3000.0) * wave(k, 100.0); })));
}

TEST(LastingMotion, MotionWithinTwoCountsIsStandstill) {
  EXPECT_TRUE(stands(series([](double k) { return k < length / 4.0 ? 1e3 : 11.0 + 0.9 * wave(k, 40.0); })));
  EXPECT_FALSE(stands(series([](double k) { return 11.0 + 1.1 * wave(k, 40.0); })));
}

TEST(LastingMotion, TorqueThatRisesSteadilyHasNotSettled) {
  EXPECT_TRUE(torque_has_settled(series([](double) { return 0.3; }), 1e-3));
  EXPECT_TRUE(torque_has_settled(series([](double k) { return 0.3 + 0.01 * std::exp(-k / 300.0); }), 1e-3));
  EXPECT_TRUE(torque_has_settled(series([](double k) { return 0.3 + 1e-5 * std::log(1.0 + k); }), 1e-3));
  EXPECT_TRUE(torque_has_settled(series([](double k) { return 0.3 + 0.2 * wave(k, 100.0); }), 1e-3));
  EXPECT_FALSE(torque_has_settled(series([](double k) { return 0.3 + 1e-6 * k; }), 1e-3));
  EXPECT_FALSE(torque_has_settled(series([](double k) { return 0.3 + 0.2 * wave(k, 8.0 * length); }), 1e-3));
}

}  // namespace
}  // namespace zerocount::theory
