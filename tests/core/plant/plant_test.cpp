// The rotor on its contact: closed forms where there are any, and invariants where there are not.
#include "core/plant/plant.hpp"

#include "core/motion/parameters.hpp"
#include "tests/core/plant/held_plant.hpp"
#include "tests/support/test.hpp"

namespace zerocount::plant {
namespace {

using namespace testing;

friction::FrictionAlongRotor without_creep(friction::FrictionParameters friction = {}) {
  friction.alpha = 0.0;
  return {friction, {}};
}

TEST(PlantAtConstantTorque, EndsOnTheUnloadingLoopsAndStays) {
  PreslidingPlant plant({}, without_creep(), {}, machine_tolerance);
  for (int k = 0; k < 2000; ++k) hold(plant, 0.02, sample);
  const double theta = plant.theta();
  const std::size_t depth = plant.spring().depth();
  EXPECT_NEAR(plant.spring().torque(), 0.02, 1e-9 * count * 860);
  EXPECT_EQ(plant.omega(), 0.0);
  for (int k = 0; k < 20000; ++k) hold(plant, 0.02, sample);
  EXPECT_EQ(plant.theta(), theta);
  EXPECT_EQ(plant.spring().depth(), depth);
}

TEST(Plant, OppositeTorqueGivesTheOppositeMotionBitForBit) {
  std::mt19937 random(22);
  std::normal_distribution<double> torque(0.0, 0.4);
  PreslidingPlant plant({}, {{}, {}}, {.preload = 0.05}, machine_tolerance);
  PreslidingPlant mirror({}, {{}, {}}, {.preload = -0.05}, machine_tolerance);
  for (int k = 0; k < 3000; ++k) {
    const double u = torque(random);
    hold(plant, u, sample);
    hold(mirror, -u, sample);
    ASSERT_EQ(plant.theta(), -mirror.theta()) << k;
    ASSERT_EQ(plant.omega(), -mirror.omega()) << k;
  }
  EXPECT_GT(plant.breakaways(), 10);
}

TEST(PlantThroughBreakawayAndReStick, TheNewContactStartsWithTheTorqueOfTheOldOne) {
  PreslidingPlant plant({}, {{}, {}}, {}, machine_tolerance);
  while (!plant.sliding()) hold(plant, 0.4, 1e-6);
  const double torque = plant.spring().torque();
  const double hook_torque = torque + 0.2 * plant.omega();
  EXPECT_NEAR(hook_torque, plant.contact().breakaway, 1e-3);
  double u = 0.4;
  for (int k = 0; k < 20; ++k) hold(plant, u, sample);
  EXPECT_TRUE(plant.sliding());
  const double theta = plant.theta();
  u = -0.1;
  while (plant.sliding()) hold(plant, u, 1e-7);
  EXPECT_GT(plant.theta(), theta);
  EXPECT_NEAR(plant.spring().torque(), torque, 1e-4);
  EXPECT_LT(std::abs(plant.creep().extension), 1e-8);
}

TEST(PlantOnAProfile, TakesTheParametersWhereItSticks) {
  const auto profile = std::make_shared<const friction::Profile>(
      friction::Profile{friction::Marginal::normal, 100.0, 20.0, {0.0, 1.0}, {0.0, 0.5}});
  friction::FrictionAlongRotor friction;
  friction.profiled.push_back({&friction::FrictionParameters::k1, profile});
  const double start = 1.25;
  PreslidingPlant plant({}, friction, {.position = start}, machine_tolerance);
  EXPECT_DOUBLE_EQ(plant.contact().k1, 100.0 + 20.0 * (std::cos(start) + 0.5 * std::sin(start)));
  const double before = plant.contact().k1;
  for (int k = 0; k < 100; ++k) hold(plant, 0.45, sample);
  EXPECT_TRUE(plant.sliding());
  EXPECT_EQ(plant.contact().k1, before);
  while (plant.sliding()) hold(plant, -0.2, 1e-7);
  const double at = start + plant.theta();
  EXPECT_NEAR(plant.contact().k1, 100.0 + 20.0 * (std::cos(at) + 0.5 * std::sin(at)), 1e-3);
  EXPECT_NE(plant.contact().k1, before);
}

TEST(Plant, ThrowsOnAMotionItCannotFollow) {
  motion::PlantParameters rotor;
  rotor.inertia = 1e-200;
  PreslidingPlant plant(rotor, {{}, {}}, {}, machine_tolerance);
  hold(plant, 0.1, sample);
  EXPECT_FALSE(plant.finite());
}

// Torque beyond any breakaway, until the hook slides, and none until it sticks again.
template <class AnyPlant>
void slide_once(AnyPlant& plant, double torque) {
  for (int k = 0; k < 1000 && !plant.sliding(); ++k) hold(plant, torque, sample);
  for (int k = 0; k < 100000 && plant.sliding(); ++k) hold(plant, 0.0, sample);
}

template <class Law>
void expect_next_contact_at_each_re_stick() {
  friction::FrictionAlongRotor friction{};
  friction.per_contact.push_back(
      {&friction::FrictionParameters::breakaway, [](std::uint64_t contact) {
         return 0.2 + 0.2 * friction::contact_uniform({.key = {1, 2}, .stream = 3}, 17, contact);
       }});
  PlantWith<Law> plant({}, friction, {}, machine_tolerance);
  EXPECT_EQ(plant.contact().breakaway, friction::FrictionParameters{}.breakaway);
  for (int contact = 1; contact <= 20; ++contact) {
    slide_once(plant, contact % 2 == 0 ? 0.5 : -0.5);
    ASSERT_EQ(plant.breakaways(), contact);
    const double u = random::open_uniform(random::random_bits_at({.key = {1, 2}, .stream = 3}, 17, contact));
    EXPECT_EQ(plant.contact().breakaway, 0.2 + 0.2 * u);
    EXPECT_EQ(plant.contact().k1, friction::FrictionParameters{}.k1);
  }
}

TEST(PlantWithContactsThatDiffer, HasTheNextContactAtEachReStick) {
  expect_next_contact_at_each_re_stick<friction::PreslidingFriction>();
  expect_next_contact_at_each_re_stick<friction::CoulombFriction>();
}

// What the plant finds at t = 0: a moving rotor, arrival from sliding, a history of the spring.

using namespace testing;

constexpr double damping = 0.2;    // N m s/rad, of PlantParameters
constexpr double breakaway = 0.3;  // N m, of FrictionParameters

TEST(PlantWithVelocity, BreaksAwayImmediatelyIfTheDamperTorqueExceedsBreakaway) {
  for (const double side : {1.0, -1.0}) {
    PreslidingPlant holding({}, {}, {.velocity = side * 0.99 * breakaway / damping}, machine_tolerance);
    hold(holding, 0.0, 1e-7);
    EXPECT_FALSE(holding.sliding());
    PreslidingPlant sliding({}, {}, {.velocity = side * 1.01 * breakaway / damping}, machine_tolerance);
    EXPECT_FALSE(sliding.sliding());
    hold(sliding, 0.0, 1e-7);
    EXPECT_TRUE(sliding.sliding());
    EXPECT_EQ(sliding.breakaways(), 1);
  }
}

// The spring of a preloaded contact carries nothing but rounding, of either sign. A contact that begins with
// that remembers no more than one that begins with nothing.
TEST(PlantWithVelocity, BreakawayDoesNotDependOnThePreload) {
  for (const double preload : {0.11, -0.11, 0.17, -0.17, 0.23}) {
    PreslidingPlant one({}, {}, {.velocity = 1.2 * breakaway / damping}, machine_tolerance);
    PreslidingPlant other({}, {}, {.preload = preload, .velocity = 1.2 * breakaway / damping},
                          machine_tolerance);
    for (int k = 0; k < 60; ++k) {
      hold(one, -0.05, sample);
      hold(other, -0.05, sample);
      ASSERT_EQ(one.theta(), other.theta()) << preload << ' ' << k;
      if (k > 0) {
        ASSERT_EQ(one.sliding() ? 0u : one.spring().depth(), other.sliding() ? 0u : other.spring().depth());
      }
    }
    EXPECT_FALSE(one.sliding());
    EXPECT_EQ(one.breakaways(), 1);
  }
}

TEST(PlantArrivingFromSliding, SlidesFromTheStartAndSticksWithTheBreakawayTorque) {
  for (const double side : {1.0, -1.0}) {
    motion::PlantStart start;
    start.velocity = side * 0.4;
    start.sliding = true;
    PreslidingPlant plant({}, {}, start, machine_tolerance);
    EXPECT_TRUE(plant.sliding());
    EXPECT_EQ(plant.theta(), 0.0);
    EXPECT_EQ(plant.omega(), start.velocity);
    EXPECT_EQ(plant.breakaways(), 0);
    while (plant.sliding()) hold(plant, side * 0.1, 1e-6);
    EXPECT_NEAR(plant.spring().torque(), side * breakaway, 1e-3);
    EXPECT_GT(side * plant.theta(), 0.0);
  }
}

TEST(PlantArrivingFromSliding, HasNoContactToRemember) {
  motion::PlantStart bare;
  bare.velocity = -0.8;
  bare.sliding = true;
  motion::PlantStart full = bare;
  full.hardening = 1e-5;
  full.preload = 0.1;
  full.history = {0.05, -0.02};
  PreslidingPlant one({}, {}, bare, machine_tolerance);
  PreslidingPlant other({}, {}, full, machine_tolerance);
  for (int k = 0; k < 50; ++k) {
    hold(one, 0.02, sample);
    hold(other, 0.02, sample);
    ASSERT_EQ(one.theta(), other.theta());
    ASSERT_EQ(one.creep().hardening, other.creep().hardening);
  }
}

TEST(PlantArrivingFromSliding, TakesTheBreakawayTorqueOfTheRotorAngle) {
  friction::FrictionAlongRotor friction;
  friction.profiled.push_back({&friction::FrictionParameters::breakaway,
                               std::make_shared<const friction::Profile>(friction::Profile{
                                   friction::Marginal::normal, 0.2, 0.05, {0.0, 1.0}, {0.0, 0.5}})});
  const double angle = 1.25;
  PreslidingPlant plant({}, friction, {.position = angle, .velocity = 0.3, .sliding = true},
                        machine_tolerance);
  const double level = 0.2 + 0.05 * (std::cos(angle) + 0.5 * std::sin(angle));
  EXPECT_DOUBLE_EQ(plant.contact().breakaway, level);
  while (plant.sliding()) hold(plant, 0.0, 1e-7);
  EXPECT_NEAR(plant.spring().torque(), level, 1e-5);
}

TEST(PlantWithHistory, StandsAtZeroWithoutTorque) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> torque(-0.25, 0.25);
  for (int trial = 0; trial < 50; ++trial) {
    motion::PlantStart start;
    start.preload = trial % 3 == 0 ? 0.0 : torque(random);
    start.hardening = trial % 2 == 0 ? 0.0 : 1e-6;
    for (int i = 0; i <= trial; ++i) start.history.push_back(torque(random));
    PreslidingPlant plant({}, {}, start, machine_tolerance);
    EXPECT_EQ(plant.theta(), 0.0);
    EXPECT_NEAR(plant.spring().torque(), 0.0, 1e-15);
    EXPECT_EQ(plant.creep().extension, 0.0);
    EXPECT_EQ(plant.creep().hardening, start.hardening);
    EXPECT_EQ(plant.deepest(), static_cast<std::int64_t>(plant.spring().depth()));
    for (int k = 0; k < 100; ++k) hold(plant, 0.0, sample);
    EXPECT_EQ(plant.theta(), 0.0);
    EXPECT_EQ(plant.omega(), 0.0);
  }
}

TEST(PlantWithHistory, AHistoryOfOneLevelEqualsAPreload) {
  PreslidingPlant preloaded({}, {}, {.preload = -0.12}, machine_tolerance);
  motion::PlantStart start;
  start.history = {-0.12};
  PreslidingPlant loaded({}, {}, start, machine_tolerance);
  EXPECT_EQ(loaded.spring().depth(), preloaded.spring().depth());
  EXPECT_NEAR(loaded.spring().elongation(), preloaded.spring().elongation(), 1e-19);
  for (int k = 0; k < 200; ++k) {
    hold(preloaded, 0.05 * std::sin(0.3 * k), sample);
    hold(loaded, 0.05 * std::sin(0.3 * k), sample);
    EXPECT_NEAR(loaded.theta(), preloaded.theta(), 1e-9 * count);
  }
}

TEST(PlantWithHistory, ForgetsReversalsWipedOutByALargerTorque) {
  motion::PlantStart plain;
  plain.history = {0.2, -0.1, 0.06};
  motion::PlantStart full;
  full.history = {0.05, -0.1, 0.03, 0.2, 0.1, 0.15, -0.1, -0.02, -0.06, 0.06, -0.01, 0.02};
  PreslidingPlant one({}, {}, plain, machine_tolerance);
  PreslidingPlant other({}, {}, full, machine_tolerance);
  EXPECT_EQ(one.spring().depth(), 3u);
  EXPECT_EQ(other.spring().depth(), 5u);  // and, inside, the last two
  full.history.resize(10);
  EXPECT_EQ(PreslidingPlant({}, {}, full, machine_tolerance).spring().depth(), 3u);
  for (int k = 0; k < 100; ++k) {
    hold(one, -0.15, sample);
    hold(other, -0.15, sample);
  }
  EXPECT_NEAR(one.spring().torque(), other.spring().torque(), 1e-9);
}

TEST(PlantWithHistory, HoldsAnyNumberOfReversals) {
  motion::PlantStart start;
  constexpr int reversals = 100000;
  for (int i = 0; i < reversals; ++i)
    start.history.push_back((i % 2 == 0 ? 0.25 : -0.25) * (1.0 - static_cast<double>(i) / reversals));
  PreslidingPlant plant({}, {}, start, machine_tolerance);
  EXPECT_EQ(plant.spring().depth(), static_cast<std::size_t>(reversals));
  EXPECT_NEAR(plant.spring().torque(), 0.0, 1e-15);
  plant.advance({0.0, 0.28, 20.0}, 1.0);
  EXPECT_LT(plant.spring().depth(), 10u);
  EXPECT_TRUE(plant.finite());
}

TEST(PlantWithHistory, MirrorsBitForBit) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> torque(-0.2, 0.2);
  for (int trial = 0; trial < 20; ++trial) {
    motion::PlantStart start;
    motion::PlantStart mirrored;
    start.preload = torque(random);
    start.velocity = torque(random);
    for (int i = 0; i < 9; ++i) start.history.push_back(torque(random));
    mirrored.preload = -start.preload;
    mirrored.velocity = -start.velocity;
    for (const double level : start.history) mirrored.history.push_back(-level);
    PreslidingPlant plant({}, {}, start, machine_tolerance);
    PreslidingPlant mirror({}, {}, mirrored, machine_tolerance);
    for (int k = 0; k < 100; ++k) {
      const motion::TorqueCourse course{torque(random), 3.0 * torque(random), 2000.0};
      plant.advance(course, sample);
      mirror.advance({-course.now, -course.settled, course.rate}, sample);
      ASSERT_EQ(plant.theta(), -mirror.theta());
      ASSERT_EQ(plant.omega(), -mirror.omega());
    }
  }
}

TEST(PlantOnASpringAlone, EqualsThePreslidingPlantWithoutCreepBitForBit) {
  friction::FrictionAlongRotor spring;
  spring.model = friction::FrictionModel::spring;
  friction::FrictionAlongRotor presliding;
  presliding.uniform.alpha = 0.0;
  const motion::PlantStart start{.hardening = 3e-6, .preload = 0.1, .velocity = 0.2};
  PreslidingPlant one({}, spring, start, machine_tolerance);
  PreslidingPlant other({}, presliding, start, machine_tolerance);
  std::mt19937 random(13);
  std::normal_distribution<double> torque(0.0, 0.6);
  for (int k = 0; k < 500; ++k) {
    const double u = torque(random);
    hold(one, u, sample);
    hold(other, u, sample);
    ASSERT_EQ(one.theta(), other.theta());
    ASSERT_EQ(one.creep().extension, 0.0);
  }
  EXPECT_GT(one.breakaways(), 3);  // creep stays off at every new contact
}

// The plant under the torque of a first-order amplifier: closed forms, limits, and the rest rule.

using namespace testing;

friction::FrictionAlongRotor spring_alone(friction::FrictionParameters friction = {}) {
  return {friction, {}, friction::FrictionModel::spring};
}

/// Random torques, which an amplifier follows with a lag from sample to sample.
class RandomTorques {
 public:
  RandomTorques(unsigned seed, double size, double rate) : random_(seed), torque_(0.0, size), rate_(rate) {}
  motion::TorqueCourse next() {
    const double now = motion::course_after(course_, sample).now;
    return course_ = {now, torque_(random_), rate_};
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> torque_;
  double rate_;
  motion::TorqueCourse course_{};
};

// 10¹² Hz, the highest bandwidth that the drive has: the torque is there in a picosecond.
TEST(PlantUnderAnAmplifier, IsIntegratedUpToTheHighestBandwidth) {
  const double rate = 2.0 * std::numbers::pi * 1e12;
  for (const friction::FrictionModel model :
       {friction::FrictionModel::presliding, friction::FrictionModel::spring,
        friction::FrictionModel::coulomb}) {
    friction::FrictionAlongRotor friction;
    friction.model = model;
    Plant amplified({}, friction, {}, machine_tolerance);
    Plant constant({}, friction, {}, machine_tolerance);
    double now = 0.0;
    for (const double u : {0.2, -0.1, 0.45, 0.5, -0.2, 0.1}) {
      amplified.advance({now, u, rate}, sample);
      constant.advance(motion::constant_torque(u), sample);
      now = u;
      EXPECT_TRUE(amplified.finite());
      EXPECT_NEAR(amplified.theta(), constant.theta(), 2.0 / rate);
    }
  }
}

TEST(PlantUnderAnAmplifier, OppositeTorqueGivesTheOppositeMotionBitForBit) {
  Plant plant({}, {}, {}, machine_tolerance);
  Plant mirror({}, {}, {}, machine_tolerance);
  RandomTorques torques(33, 0.4, 1500.0);
  for (int k = 0; k < 3000; ++k) {
    const motion::TorqueCourse course = torques.next();
    plant.advance(course, sample);
    mirror.advance({-course.now, -course.settled, course.rate}, sample);
    ASSERT_EQ(plant.theta(), -mirror.theta()) << k;
    ASSERT_EQ(plant.omega(), -mirror.omega()) << k;
  }
  EXPECT_GT(plant.breakaways(), 10);
}

// Loaded from virgin by a torque so slow that every sample changes it by less than the rest rule notices: the
// spring carries u − c·ω − J·dω/dt all the same, within the ε·(k1 + k2)/k1 that the rule promises.
TEST(PlantUnderAnAmplifier, FollowsAVerySlowTorque) {
  const friction::FrictionParameters friction;
  const motion::PlantParameters rotor;
  const double promised = machine_tolerance.elongation * (friction.k1 + friction.k2) / friction.k1;
  for (const double duration : {sample, 1.0, 200.0}) {  // in one step, or in many
    for (const double rate : {1e-8, 1e-6, 1e-4}) {
      PreslidingPlant plant(rotor, spring_alone(), {}, machine_tolerance);
      motion::TorqueCourse course{0.0, 0.02, rate};
      const double end = std::min(200.0, 20000 * duration);
      for (double t = 0.0; t < end - 0.5 * duration; t += duration) {
        plant.advance(course, duration);
        course = motion::course_after(course, duration);
      }
      const double change = rate * (course.settled - course.now);
      const double omega =
          change / friction::stiffness_on(plant.spring().branch(), plant.spring().elongation());
      const double carried = course.now - rotor.presliding_damping * omega;
      EXPECT_NEAR(plant.theta(), friction::virgin_elongation(friction, carried), 1.01 * promised)
          << duration << ' ' << rate;
      EXPECT_GT(plant.theta(), 0.0);
    }
  }
}

TEST(PlantUnderAnAmplifier, RestsOnceTheTorqueHasSettled) {
  for (const double rate : {50.0, 5000.0, 5e5}) {
    PreslidingPlant plant({}, spring_alone(), {}, machine_tolerance);
    motion::TorqueCourse course{0.0, 0.02, rate};
    for (int k = 0; k < 4000; ++k) {
      plant.advance(course, sample);
      course = motion::course_after(course, sample);
    }
    const double theta = plant.theta();
    EXPECT_NEAR(plant.spring().torque(), 0.02, 1e-9 * count * 860);
    EXPECT_EQ(plant.omega(), 0.0);
    for (int k = 0; k < 1000; ++k) {
      plant.advance(course, sample);
      course = motion::course_after(course, sample);
    }
    EXPECT_EQ(plant.theta(), theta);
  }
}

}  // namespace
}  // namespace zerocount::plant
