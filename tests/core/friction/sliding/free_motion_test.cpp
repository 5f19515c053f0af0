// A rotor on an air bearing, against the textbook's solution in a hundred digits.
#include "core/friction/sliding/free_motion.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "core/friction/sliding/sliding.hpp"
#include "core/plant/plant.hpp"
#include "tests/support/test.hpp"

namespace zerocount::friction {
namespace {

using Digits = boost::multiprecision::cpp_bin_float_100;

constexpr motion::MotionTolerance tolerance{4e-16};

struct Push {
  motion::PlantParameters plant;
  FreeMotion start;
  motion::TorqueCourse torque;
  double duration;
};

/// Dampings from none to overwhelming, amplifiers from slower than the rotor to instantaneous, and both of
/// one rate, where the textbook divides by zero.
class RandomPushes {
 public:
  Push next() {
    Push push;
    push.plant.inertia = log_uniform(1e-5, 1e2);
    const double duration = log_uniform(1e-6, 1.0);
    push.duration = duration;
    push.plant.presliding_damping =
        chance(0.2) ? 0.0 : push.plant.inertia / duration * log_uniform(1e-12, 1e4);
    push.start = {uniform(-1e-3, 1e-3), uniform(-1.0, 1.0)};
    const double rate = push.plant.presliding_damping / push.plant.inertia;
    const double any = log_uniform(1e-12, 1e9) / duration;
    push.torque = {uniform(-0.3, 0.3), uniform(-0.3, 0.3), chance(0.2) ? 0.0 : chance(0.2) ? rate : any};
    if (chance(0.2)) push.torque.rate = rate * (1.0 + log_uniform(1e-16, 1e-3));
    return push;
  }

  double uniform(double low, double high) { return low + (high - low) * unit_(engine_); }

 private:
  double log_uniform(double low, double high) { return low * std::pow(high / low, unit_(engine_)); }
  bool chance(double probability) { return unit_(engine_) < probability; }

  std::mt19937_64 engine_{7};
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
};

/// ω and θ by the inverse Laplace transform, with what would divide by zero moved by 1e-30: far below what a
/// double shows, far above the rounding of a hundred digits.
struct Textbook {
  Digits theta;
  Digits omega;
};

Textbook textbook(const Push& push) {
  const Digits hair("1e-30");
  const Digits J = push.plant.inertia;
  const Digits t = push.duration;
  const Digits a = Digits(push.plant.presliding_damping) / J + hair;
  Digits r = Digits(push.torque.rate) + 3 * hair;
  const Digits U = push.torque.settled;
  Digits lag = (Digits(push.torque.now) - U) / J;
  if (push.torque.rate == 0.0) r = 3 * hair;
  const Digits slow = exp(-a * t);
  const Digits fast = exp(-r * t);
  const Digits w0 = push.start.omega;
  Textbook end;
  const Digits settled = push.torque.rate == 0.0 ? Digits(push.torque.now) / J : U / J;
  if (push.torque.rate == 0.0) lag = 0;
  end.omega = w0 * slow + settled / a * (1 - slow) + lag * (slow - fast) / (r - a);
  end.theta = push.start.theta + w0 * (1 - slow) / a + settled / a * (t - (1 - slow) / a) +
              lag / (r - a) * ((1 - slow) / a - (1 - fast) / r);
  return end;
}

TEST(FreeMotion, IsThatOfTheTextbook) {
  RandomPushes pushes;
  for (int i = 0; i < 4000; ++i) {
    const Push push = pushes.next();
    const FreeMotion end = free_motion(push.plant, push.start, push.torque, push.duration);
    const Textbook exact = textbook(push);
    // What the terms add up to at most: theirs is the rounding.
    const double speed =
        std::abs(push.start.omega) +
        (std::abs(push.torque.now) + std::abs(push.torque.settled)) / push.plant.inertia * push.duration;
    ASSERT_NEAR(end.omega, static_cast<double>(exact.omega), 1e-14 * speed) << i;
    ASSERT_NEAR(end.theta, static_cast<double>(exact.theta),
                1e-14 * speed * push.duration + 3e-16 * std::abs(push.start.theta))
        << i;
  }
}

FrictionAlongRotor no_friction() {
  FrictionAlongRotor friction;
  friction.model = FrictionModel::none;
  return friction;
}

// What a contact would begin with is not there.
TEST(FreePlant, HasNoContact) {
  RandomPushes pushes;
  motion::PlantStart start;
  start.hardening = 1e-5;
  start.preload = 0.1;
  start.history = {0.2, -0.1};
  plant::Plant plant({}, no_friction(), start, tolerance);
  for (int k = 0; k < 100; ++k) {
    EXPECT_TRUE(plant.sliding());
    EXPECT_EQ(plant.read().creep.extension, 0.0);
    EXPECT_EQ(plant.read().creep.hardening, 0.0);
    EXPECT_EQ(plant.read().depth, 0);
    plant.advance(pushes.next().torque, 5e-4);
  }
  EXPECT_EQ(plant.breakaways(), 0);
  EXPECT_EQ(plant.breakaway(), Breakaway::never);
  EXPECT_TRUE(plant.finite());
}

TEST(FreePlant, OppositeTorqueGivesTheOppositeMotionBitForBit) {
  RandomPushes pushes;
  plant::Plant plant({}, no_friction(), {.velocity = 0.1}, tolerance);
  plant::Plant mirror({}, no_friction(), {.velocity = -0.1}, tolerance);
  for (int k = 0; k < 1000; ++k) {
    const motion::TorqueCourse course = pushes.next().torque;
    plant.advance(course, 5e-4);
    mirror.advance({-course.now, -course.settled, course.rate}, 5e-4);
    ASSERT_EQ(plant.theta(), -mirror.theta()) << k;
    ASSERT_EQ(plant.omega(), -mirror.omega()) << k;
  }
}

// The end of a slide within a step of its series.

SlidingSeries with_velocity(std::initializer_list<double> coefficients) {
  SlidingSeries series{};
  std::size_t k = 0;
  for (const double coefficient : coefficients) series.omega[k++] = coefficient;
  return series;
}

TEST(SlidingEvent, IsTheFirstZeroOfTheVelocity) {
  const auto next = Slide::first_event(with_velocity({2.0, -1.0}), 5.0);
  EXPECT_EQ(next.event, Slide::Event::velocity_zero);
  EXPECT_DOUBLE_EQ(next.time, 2.0);
  EXPECT_EQ(Slide::first_event(with_velocity({2.0, -1.0}), 1.5).event, Slide::Event::none);
}

TEST(SlidingEvent, IsNotTheRestFromWhichTheSlideStarts) {
  EXPECT_EQ(Slide::first_event(with_velocity({0.0, 1.0}), 5.0).event, Slide::Event::none);
  const auto back = Slide::first_event(with_velocity({0.0, 3.0, -1.0}), 5.0);
  EXPECT_EQ(back.event, Slide::Event::velocity_zero);
  EXPECT_DOUBLE_EQ(back.time, 3.0);
  // Released at the very level by a torque that moves: the acceleration, too, starts at zero.
  const auto released = Slide::first_event(with_velocity({0.0, 0.0, 4.0, -1.0}), 5.0);
  EXPECT_EQ(released.event, Slide::Event::velocity_zero);
  EXPECT_DOUBLE_EQ(released.time, 4.0);
  EXPECT_EQ(Slide::first_event(with_velocity({}), 5.0).event, Slide::Event::none);
}

}  // namespace
}  // namespace zerocount::friction
