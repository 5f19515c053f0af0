// Amonton–Coulomb friction: it stands exactly, and moves as the closed forms say.
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "core/friction/sliding/none.hpp"
#include "core/friction/sliding/sliding.hpp"
#include "core/plant/plant.hpp"
#include "tests/core/plant/held_plant.hpp"
#include "tests/support/test.hpp"

namespace zerocount::friction {
namespace {

using CoulombPlant = plant::PlantWith<CoulombFriction>;

using testing::hold;

constexpr motion::MotionTolerance coulomb_tolerance{4e-16};
constexpr double level = 0.3;  // N m

/// Coulomb friction without Stribeck effect: the friction while sliding is the breakaway torque times
/// `ratio`.
FrictionAlongRotor coulomb(double ratio = 1.0) {
  FrictionAlongRotor friction;
  friction.model = FrictionModel::coulomb;
  friction.uniform.breakaway = level;
  friction.uniform.coulomb_ratio = ratio;
  return friction;
}

double next_after(double value) {
  return std::nextafter(value, std::numeric_limits<double>::infinity());
}

TEST(CoulombPlant, StandsExactlyStillBelowTheBreakawayTorque) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> torque(-level, level);
  CoulombPlant plant({}, coulomb(0.5), {}, coulomb_tolerance);
  double now = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const motion::TorqueCourse course{now, torque(random), 1e4 * std::abs(torque(random))};
    plant.advance(course, 5e-4);
    now = motion::course_after(course, 5e-4).now;
    hold(plant, k % 2 == 0 ? level : -level, 5e-4);
    ASSERT_EQ(plant.theta(), 0.0);
    ASSERT_EQ(plant.omega(), 0.0);
  }
  EXPECT_EQ(plant.breakaways(), 0);
}

TEST(CoulombPlant, HasNoPreslidingState) {
  motion::PlantStart start;
  start.hardening = 1e-5;
  start.preload = 0.1;
  start.history = {0.2, -0.1};
  CoulombPlant plant({}, coulomb(), start, coulomb_tolerance);
  for (const double torque : {0.0, 0.5, -0.2, -0.6}) {
    EXPECT_EQ(plant.creep().extension, 0.0);
    EXPECT_EQ(plant.creep().hardening, 0.0);
    EXPECT_EQ(plant.depth(), 0);
    hold(plant, torque, 0.01);
  }
  EXPECT_NE(plant.theta(), 0.0);
}

TEST(CoulombPlant, SlidesOnImmediatelyIfTheNewContactIsWeaker) {
  const auto weaker = std::make_shared<const Profile>(
      Profile{Marginal::normal, level, 0.2, {0.0, 0.0}, {0.0, -1.0}});  // falls with the angle
  FrictionAlongRotor friction = coulomb();
  friction.profiled.push_back({&FrictionParameters::breakaway, weaker});
  CoulombPlant plant({}, friction, {.velocity = 5.0}, coulomb_tolerance);
  const double torque = level - 0.03;
  hold(plant, torque, 1.0);
  EXPECT_TRUE(plant.sliding());
  EXPECT_GT(plant.breakaways(), 0);
  EXPECT_LT(plant.contact().breakaway, torque);
  const double theta = plant.theta();
  hold(plant, torque, 0.1);
  EXPECT_GT(plant.theta(), theta);
}

TEST(CoulombPlant, NeedsTheStaticLevelToStartButNotToKeepSliding) {
  const double between = 0.9 * level;
  CoulombPlant standing({}, coulomb(0.8), {}, coulomb_tolerance);
  hold(standing, between, 1.0);
  EXPECT_EQ(standing.theta(), 0.0);
  CoulombPlant moving({}, coulomb(0.8), {.velocity = 1.0}, coulomb_tolerance);
  hold(moving, between, 1.0);
  EXPECT_GT(moving.omega(), 1.0);
}

// u − F = (U − F)·(1 − exp(−r(t − t*))) from the instant t* at which u passes F.
TEST(CoulombPlant, IsReleasedByAnAmplifierAtTheExactInstant) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    motion::PlantParameters rotor;
    rotor.sliding_damping = 0.0;
    const double side = unit(random) < 0.5 ? -1.0 : 1.0;
    const motion::TorqueCourse course{side * level * (2.0 * unit(random) - 1.0),
                                      side * level * (1.0 + unit(random)),
                                      std::pow(10.0, 1.0 + 4.0 * unit(random))};
    const double release =
        std::log((course.now - course.settled) / (side * level - course.settled)) / course.rate;
    const double excess = (course.settled - side * level) / rotor.inertia;
    for (const double t : {0.1, 1.0, 3.0, 30.0}) {
      CoulombPlant standing(rotor, coulomb(), {}, coulomb_tolerance);
      standing.advance(course, 0.9999999 * release);
      ASSERT_EQ(standing.theta(), 0.0);
      ASSERT_FALSE(standing.sliding());
      const double since = t / course.rate;
      CoulombPlant plant(rotor, coulomb(), {}, coulomb_tolerance);
      plant.advance(course, release + since);
      const double omega = excess * (since + std::expm1(-t) / course.rate);
      const double theta =
          excess * (0.5 * since * since - since / course.rate - std::expm1(-t) / course.rate / course.rate);
      // The instant is known to the rounding of the torque over its rate of change.
      const double late = 1e-15 * level / (course.rate * std::abs(course.settled - side * level)) + 1e-16;
      const double left_out = 10.0 * coulomb_tolerance.elongation;
      ASSERT_NEAR(plant.omega(), omega, std::abs(excess) * late + 1e-14 * std::abs(omega) + left_out / since)
          << trial;
      ASSERT_EQ(plant.breakaways(), 1) << trial;  // no false start at the level
      ASSERT_NEAR(plant.theta(), theta, std::abs(omega) * late + 1e-14 * std::abs(theta) + left_out) << trial;
    }
  }
}

// Torques that touch the level, or pass it by no more than rounding: none may hang or lose the motion.
TEST(CoulombPlant, HandlesATorqueEqualToBreakaway) {
  for (const double ratio : {1.0, 0.8, 0.3, 0.1}) {
    for (const double side : {1.0, -1.0}) {
      const double beyond = side * next_after(level);
      const double within = side * std::nextafter(level, 0.0);
      const motion::TorqueCourse courses[] = {
          motion::constant_torque(side * level),
          motion::constant_torque(beyond),
          {beyond, 0.0, 1e3},
          {beyond, -side * level, 1e3},
          {beyond, -2.0 * side * level, 1e3},
          {beyond, within, 1e3},
          {within, beyond, 1e3},
          {side * level, beyond, 1e3},
          {side * level, 2.0 * beyond, 1e3},
          {side * level, 2.0 * beyond, 1e-12},
          {side * level, 0.0, 1e3},
          {0.0, side * level, 1e5},
          {0.0, beyond, 1e5},
          {side * level, 2.0 * beyond, 1e9},
          {side * level, -side * level, 1e3},
          {2.0 * beyond, side * level, 1e4},
      };
      for (const motion::TorqueCourse& course : courses) {
        CoulombPlant plant({}, coulomb(ratio), {}, coulomb_tolerance);
        for (int k = 0; k < 20; ++k) plant.advance(motion::course_after(course, k * 5e-4), 5e-4);
        ASSERT_TRUE(plant.finite()) << ratio << ' ' << course.now << ' ' << course.settled;
        const bool moves = std::abs(course.now) > 1.5 * level || std::abs(course.settled) > 1.5 * level;
        if (moves && course.rate > 1.0) {
          EXPECT_GT(plant.theta() * motion::course_after(course, 1.0).now, 0.0)
              << course.now << ' ' << course.settled;
        }
        if (std::abs(course.now) <= level && std::abs(course.settled) <= level) {
          EXPECT_EQ(plant.theta(), 0.0);
        }
      }
    }
  }
}

// A load, a ripple and a vibration take the torque through the level at any rate, and rounding puts it on
// either side of the level at the instant found. A coupling at 1e5 rad/s takes some 200 steps a sample.
TEST(CoulombPlant, IsReleasedByALoadOrADisturbanceInABoundedNumberOfSteps) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto log_uniform = [&](double low, double high) { return low * std::pow(high / low, unit(random)); };
  std::int64_t breakaways = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    motion::PlantParameters rotor;
    rotor.inertia = log_uniform(1e-4, 1e-2);
    if (trial % 3 != 0) rotor.load = {log_uniform(1e-5, 1e-2), log_uniform(1.0, 1e5), log_uniform(1e-6, 0.1)};
    CoulombPlant plant(rotor, coulomb(trial % 2 == 0 ? 1.0 : unit(random)), {}, {1e-10 * testing::count});
    motion::Disturbance disturbance;
    if (trial % 3 != 1) disturbance.vibration = {{log_uniform(1e-4, 0.1), log_uniform(1.0, 3000.0), 1.0}};
    if (trial % 3 == 2) disturbance.ripple = {{log_uniform(1e-4, 0.1), log_uniform(1.0, 3000.0), 1.0}};
    plant.disturb(disturbance);
    for (int k = 0; k < 60; ++k) {
      plant.advance(motion::constant_torque(1.3 * level * (2.0 * unit(random) - 1.0)), 5e-4, 400);
      ASSERT_TRUE(plant.finite()) << trial << ' ' << k;
    }
    breakaways += plant.breakaways();
  }
  EXPECT_GT(breakaways, 10000);
}

// A line turns within its amplitude, and several of them within the sum. At an extreme every second
// derivative of a line is 0, and those of lines may cancel.
TEST(CoulombPlant, StandsUnderAVibrationWhosePeakIsBelowTheLevel) {
  constexpr double pi = 3.14159265358979;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double sample_time = 5e-4;
  for (const double peak : {0.2, 0.9, 0.999, 1.001}) {
    for (const double frequency : {0.25, 0.5, 1.25, 1.5, 2.25, 0.0}) {
      for (int trial = 0; trial < 12; ++trial) {
        motion::Disturbance disturbance;
        const int lines = trial < 8 ? 1 : trial - 6;
        for (int i = 0; i < lines; ++i) {
          const double turns = frequency > 0.0 && i == 0 ? frequency : 2.5 * unit(random);
          disturbance.vibration.push_back({peak * level / lines, 2.0 * pi * turns / sample_time,
                                           trial < 5 ? 0.5 * pi * trial : 6.3 * unit(random)});
        }
        CoulombPlant plant({}, coulomb(0.5), {}, coulomb_tolerance);
        plant.disturb(disturbance);
        for (int k = 0; k < 20; ++k) plant.advance(motion::constant_torque(0.0), sample_time);
        if (peak < 1.0) {
          ASSERT_EQ(plant.breakaways(), 0) << peak << ' ' << frequency << ' ' << trial;
        } else if (lines == 1 && frequency > 0.0) {
          ASSERT_GT(plant.breakaways(), 0) << frequency << ' ' << trial;
        }
      }
    }
  }
}

// The torque of a fast amplifier is no polynomial over a sample. A vibration without amplitude has the rotor
// stand by series in place of the closed form.
TEST(CoulombPlant, AZeroDisturbanceDoesNotChangeTheReleaseByAnAmplifier) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 300; ++trial) {
    CoulombPlant alone({}, coulomb(0.7), {}, coulomb_tolerance);
    CoulombPlant beside({}, coulomb(0.7), {}, coulomb_tolerance);
    motion::Disturbance disturbance;
    disturbance.vibration = {{0.0, 100.0, 0.0}};
    beside.disturb(disturbance);
    const double rate = std::pow(10.0, 2.0 + 3.0 * unit(random));
    motion::TorqueCourse course{0.0, 0.0, rate};
    for (int k = 0; k < 4; ++k) {
      course.settled = 1.2 * level * (2.0 * unit(random) - 1.0);
      alone.advance(course, 5e-4);
      beside.advance(course, 5e-4);
      course = motion::course_after(course, 5e-4);
      ASSERT_EQ(beside.breakaways(), alone.breakaways()) << trial << ' ' << k << ' ' << rate;
      ASSERT_NEAR(beside.theta(), alone.theta(), 1e-13 + 1e-9 * std::abs(alone.theta())) << trial << ' ' << k;
    }
  }
}

// Nothing could give way to a velocity but sliding.
TEST(CoulombPlant, AnInitialVelocityStartsInSliding) {
  for (const double omega : {2.0, -0.3, 1e-6}) {
    CoulombPlant sliding({}, coulomb(0.6), {.velocity = omega, .sliding = true}, coulomb_tolerance);
    CoulombPlant sticking({}, coulomb(0.6), {.velocity = omega, .sliding = false}, coulomb_tolerance);
    EXPECT_TRUE(sticking.sliding());
    for (int k = 0; k < 5; ++k) {
      hold(sliding, 0.1, 5e-4);
      hold(sticking, 0.1, 5e-4);
      EXPECT_EQ(sliding.theta(), sticking.theta());
      EXPECT_EQ(sliding.omega(), sticking.omega());
    }
  }
}

TEST(CoulombPlant, OppositeTorqueGivesTheOppositeMotionBitForBit) {
  std::mt19937 random(4);
  std::normal_distribution<double> torque(0.0, 0.4);
  CoulombPlant plant({}, coulomb(0.7), {.velocity = 0.1}, coulomb_tolerance);
  CoulombPlant mirror({}, coulomb(0.7), {.velocity = -0.1}, coulomb_tolerance);
  double now = 0.0;
  for (int k = 0; k < 3000; ++k) {
    const motion::TorqueCourse course{now, torque(random), 3000.0};
    plant.advance(course, 5e-4);
    mirror.advance({-course.now, -course.settled, course.rate}, 5e-4);
    now = motion::course_after(course, 5e-4).now;
    ASSERT_EQ(plant.theta(), -mirror.theta()) << k;
    ASSERT_EQ(plant.omega(), -mirror.omega()) << k;
  }
  EXPECT_GT(plant.breakaways(), 100);
}

// A rotor on an air bearing, against the textbook's solution in a hundred digits.

using Digits = boost::multiprecision::cpp_bin_float_100;

constexpr motion::MotionTolerance tolerance{4e-16};

struct Push {
  motion::PlantParameters plant;
  FreeMotion start;
  motion::TorqueCourse torque;
  double duration;
};

/// Random pushes of a sliding rotor: dampings from none to overwhelming, amplifiers from slower than the
/// rotor to instantaneous, and some of the rotor's own rate, where the textbook formula divides by zero.
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

/// Exact ω and θ of a push by the inverse Laplace transform. A difference that would divide by zero is moved
/// by 1e-30: far below what a double shows, far above the rounding of a hundred digits.
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

TEST(FreeMotion, MatchesTheTextbook) {
  RandomPushes pushes;
  for (int i = 0; i < 4000; ++i) {
    const Push push = pushes.next();
    const FreeMotion end = free_motion(push.plant, push.start, push.torque, push.duration);
    const Textbook exact = textbook(push);
    // The largest sum of the terms, which scales their rounding error.
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

// A free plant ignores the state in which a contact would start.
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

TEST(SlidingEvent, IsNotTheRestBeforeTheSlideStarts) {
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
