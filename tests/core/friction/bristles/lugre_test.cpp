// The LuGre law against the experiments of Canudas de Wit, Olsson, Åström and Lischinsky, "A new model for
// control of systems with friction", IEEE Trans. Automatic Control 40 (1995), sections III and IV, with their
// parameters.
#include "core/friction/presliding/spring.hpp"
#include "core/plant/plant.hpp"
#include "tests/support/test.hpp"

namespace zerocount::friction {
namespace {

using LuGrePlant = plant::PlantWith<LuGreFriction>;

constexpr double bristle_stiffness = 1e5;  // N/m
const double bristle_damping = std::sqrt(1e5);
constexpr double mass = 1.0;
constexpr double viscous_damping = 0.4;
constexpr double coulomb_level = 1.0;
constexpr double static_level = 1.5;
constexpr double stribeck_velocity = 1e-3;

LuGrePlant published(const motion::PlantStart& start = {}) {
  FrictionAlongRotor friction;
  friction.model = FrictionModel::lugre;
  friction.uniform.breakaway = static_level;
  friction.uniform.coulomb_ratio = coulomb_level / static_level;
  friction.uniform.stribeck_velocity = stribeck_velocity;
  friction.uniform.sigma0 = bristle_stiffness;
  friction.uniform.sigma1 = bristle_damping;
  return {{.inertia = mass, .sliding_damping = viscous_damping}, friction, start, {1e-15, 1e-12}};
}

double steady_friction(double velocity) {
  const double ratio = velocity / stribeck_velocity;
  return coulomb_level + (static_level - coulomb_level) * std::exp(-ratio * ratio) +
         viscous_damping * velocity;
}

/// LuGre friction torque of the plant's present state, F = σ0·z + σ1·dz/dt + σ2·ω.
double friction_force(const LuGrePlant& plant) {
  const double velocity = plant.omega();
  const double level = steady_friction(velocity) - viscous_damping * velocity;
  const double rate = velocity - bristle_stiffness * std::abs(velocity) * plant.deflection() / level;
  return bristle_stiffness * plant.deflection() + bristle_damping * rate + viscous_damping * velocity;
}

// dz/dt = 0 gives F(v) = sgn(v)·g(v) + σ2·v. On its falling part a constant force has no stable velocity, so
// a stiff velocity control holds the mass there.
TEST(LuGre, HasTheSteadyStateCurve) {
  for (const double velocity : {5e-4, -1e-3, 2e-3, 5e-3, -0.1, 0.5}) {
    LuGrePlant plant = published();
    for (int k = 0; k < 60000; ++k)
      plant.advance(motion::constant_torque(1e4 * (velocity - plant.omega())), 1e-5);
    const double steady = std::copysign(steady_friction(std::abs(plant.omega())), plant.omega());
    EXPECT_NEAR(friction_force(plant), steady, 1e-6) << velocity;
  }
}

// A force that rises at a constant rate, in small steps: the applied force at which the velocity reaches the
// Stribeck velocity.
double breakaway_force(double rate) {
  LuGrePlant plant = published();
  const double step = 1e-4 / std::max(rate, 2.0);
  double force = 0.0;
  for (std::int64_t k = 0; plant.omega() < stribeck_velocity; ++k) {
    force = rate * step * (static_cast<double>(k) + 0.5);
    plant.advance(motion::constant_torque(force), step);
  }
  return force;
}

TEST(LuGre, BreakawayForceFallsWithTheRateOfTheForce) {
  EXPECT_NEAR(breakaway_force(0.5), 1.476, 5e-4);
  EXPECT_NEAR(breakaway_force(2.0), 1.436, 5e-4);
  EXPECT_NEAR(breakaway_force(10.0), 1.307, 5e-4);
  EXPECT_NEAR(breakaway_force(20.0), 1.189, 5e-4);
}

struct Oscillation {
  double amplitude;
  double period;
};

/// Amplitude and period of an oscillation over the second half of the values: half of the range, and the mean
/// time between upward crossings of the middle.
Oscillation oscillation_of(const std::vector<double>& values, double step) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  const auto [low, high] = std::minmax_element(begin, values.end());
  const double middle = 0.5 * (*low + *high);
  std::vector<double> crossings;
  for (auto v = begin + 1; v != values.end(); ++v) {
    if (*(v - 1) < middle && *v >= middle) crossings.push_back(static_cast<double>(v - begin) * step);
  }
  const double period = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  return {0.5 * (*high - *low), period};
}

// A mass pulled by a spring of 2 N/m, whose end moves at 0.1 m/s: stick-slip.
TEST(LuGre, StickSlipsBehindASpring) {
  LuGrePlant plant = published();
  constexpr double step = 1e-3;
  std::vector<double> force;
  for (int k = 0; k < 60000; ++k) {
    const double torque = 2.0 * (0.1 * step * (k + 0.5) - plant.theta());
    plant.advance(motion::constant_torque(torque), step);
    force.push_back(torque);
  }
  EXPECT_NEAR(oscillation_of(force, step).period, 6.36, 0.01);
}

// A PID controller with the integral of a position that is to come to 1: hunting (their gains: v = 6, p = 3,
// i = 4).
TEST(LuGre, HuntsUnderIntegralControl) {
  LuGrePlant plant = published();
  constexpr double step = 1e-3;
  double integral = 0.0;
  std::vector<double> position;
  for (int k = 0; k < 300000; ++k) {
    const double error = 1.0 - plant.theta();
    integral += 4.0 * error * step;
    plant.advance(motion::constant_torque(3.0 * error + integral - 6.0 * plant.omega()), step);
    position.push_back(plant.theta());
  }
  const Oscillation hunting = oscillation_of(position, step);
  EXPECT_NEAR(hunting.amplitude, 0.0639, 2e-4);
  EXPECT_NEAR(hunting.period, 24.4, 0.1);
}

// Frictional lag: at a velocity that varies, friction is lower while it falls than while it rises.
TEST(LuGre, LagsBehindAVaryingVelocity) {
  LuGrePlant plant = published({.velocity = 2e-3, .sliding = true});
  constexpr double step = 1e-5;
  const double frequency = 25.0;  // rad/s
  double rising = 0.0;
  double falling = 0.0;
  for (int k = 0; k < 200000; ++k) {
    const double t = step * k;
    const double wanted = 2e-3 + 1e-3 * std::sin(frequency * t);
    const double before = plant.omega();
    plant.advance(motion::constant_torque(1e4 * (wanted - plant.omega()) + friction_force(plant)), step);
    const bool crosses = (before - 2e-3) * (plant.omega() - 2e-3) < 0.0;
    if (crosses && t > 1.0) (plant.omega() > before ? rising : falling) = friction_force(plant);
  }
  EXPECT_GT(rising, falling + 1e-3);
}

// A small oscillation dies away, and the rotor then stands where it is.
TEST(LuGre, ComesToRest) {
  LuGrePlant plant = published({.velocity = 1e-4});
  for (int k = 0; k < 100; ++k) plant.advance(motion::constant_torque(0.7), 1e-2);
  const double standing = plant.theta();
  EXPECT_EQ(plant.omega(), 0.0);
  EXPECT_EQ(plant.deflection(), 0.7 / bristle_stiffness);
  for (int k = 0; k < 100; ++k) plant.advance(motion::constant_torque(0.7), 1e-2);
  EXPECT_EQ(plant.theta(), standing);
}

// z approaches Fc/σ0 as 1 − exp(−x·σ0/Fc), whatever the velocity (Dahl's closed form).
TEST(Dahl, HasItsClosedFormOverTheTravel) {
  FrictionAlongRotor friction;
  friction.model = FrictionModel::dahl;
  friction.uniform.coulomb_ratio = 0.8;
  const double level = 0.8 * friction.uniform.breakaway;
  const double stiffness = friction.uniform.sigma0;
  for (const double velocity : {0.2, -3.0}) {
    plant::PlantWith<DahlFriction> plant({}, friction, {.velocity = velocity}, {4e-16, 4e-14});
    const double direction = std::copysign(1.0, velocity);
    for (int k = 1; k <= 200; ++k) {
      plant.advance(motion::constant_torque(direction * 0.5), 1e-5 * (1 + k % 7));
      const double expected =
          direction * level / stiffness * -std::expm1(-std::abs(plant.theta()) * stiffness / level);
      ASSERT_NEAR(plant.deflection(), expected, 1e-14);
      ASSERT_EQ(plant.sliding(), stiffness * std::abs(plant.deflection()) > 0.99 * level);
    }
    EXPECT_TRUE(plant.sliding());
  }
}

// The generalised Maxwell-slip model: its memory, its levels, and its limits.

using GmsPlant = plant::PlantWith<GmsFriction>;

constexpr motion::MotionTolerance gms_tolerance{4e-16, 4e-14};
constexpr double heavy_damping = 20.0;  // N m s/rad: the motion is quasi-static

FrictionAlongRotor elements(std::vector<GmsElement> of, double ratio, double attraction) {
  FrictionAlongRotor friction;
  friction.model = FrictionModel::gms;
  friction.gms_elements = std::move(of);
  friction.uniform.coulomb_ratio = ratio;
  friction.uniform.gms_attraction = attraction;
  return friction;
}

double torque_of(const GmsPlant& plant) {
  double sum = 0.0;
  for (const GmsState& state : plant.elements()) sum += state.torque;
  return sum;
}

/// Changes the torque slowly to the given level, without sliding.
void go_slowly(GmsPlant& plant, double torque) {
  const double from = torque_of(plant);
  constexpr int steps = 200;
  for (int k = 1; k <= steps; ++k)
    plant.advance(motion::constant_torque(from + (torque - from) * k / steps), 0.02);
  plant.advance(motion::constant_torque(torque), 5.0);
}

std::vector<GmsElement> random_elements(std::mt19937_64& random, std::size_t count) {
  std::uniform_real_distribution<double> uniform(0.2, 1.0);
  std::vector<GmsElement> drawn(count);
  double sum = 0.0;
  for (GmsElement& element : drawn) sum += element.weight = uniform(random);
  for (GmsElement& element : drawn) element = {500.0 * uniform(random), element.weight / sum};
  return drawn;
}

// A closed inner loop returns to where it began, and the outer branch goes on as if it had not been
// (non-local memory).
TEST(Gms, RemembersWhereAMinorLoopBegan) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 3; ++i) {
    const auto drawn = random_elements(random, 5);
    const motion::PlantParameters rotor{.sliding_damping = heavy_damping};
    GmsPlant with_loop(rotor, elements(drawn, 1.0, 1e4), {}, gms_tolerance);
    GmsPlant without(rotor, elements(drawn, 1.0, 1e4), {}, gms_tolerance);
    for (GmsPlant* plant : {&with_loop, &without}) go_slowly(*plant, 0.18);
    const double corner = with_loop.theta();
    go_slowly(with_loop, 0.02);
    EXPECT_NE(with_loop.theta(), corner);
    go_slowly(with_loop, 0.18);
    EXPECT_NEAR(with_loop.theta(), corner, 1e-9);
    for (GmsPlant* plant : {&with_loop, &without}) go_slowly(*plant, 0.25);
    EXPECT_NEAR(with_loop.theta(), without.theta(), 1e-9);
  }
}

// With Fc = Fs, where C has no effect, it is the model of Iwan: stop elements, which follow Masing's rule as
// the spring does.
TEST(Gms, IsTheSpringOfThePaperInTheLimitOfManyElements) {
  FrictionParameters spring_parameters;
  spring_parameters.breakaway = 0.05;
  constexpr std::size_t count = 100;
  // Thresholds r of equal stiffness with the density 2βk2·exp(−2βr): the means of −ln(1 − p)/2β over equal
  // parts of p.
  const auto primitive = [](double p) { return p < 1.0 ? (1.0 - p) * std::log1p(-p) + p : 1.0; };
  std::vector<GmsElement> many;
  double carried = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double low = static_cast<double>(i) / count;
    const double high = static_cast<double>(i + 1) / count;
    const double threshold = count * (primitive(high) - primitive(low)) / (2.0 * spring_parameters.beta);
    const double stiffness = spring_parameters.k2 / count;
    many.push_back({stiffness, stiffness * threshold / spring_parameters.breakaway});
    carried += many.back().weight;
  }
  many.push_back({spring_parameters.k1, 1.0 - carried});
  FrictionAlongRotor friction = elements(many, 1.0, 1e6);
  friction.uniform.breakaway = spring_parameters.breakaway;
  GmsPlant plant({.sliding_damping = heavy_damping}, friction, {}, gms_tolerance);
  HystereticSpring spring(spring_parameters);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> torque(-0.02, 0.02);
  for (int i = 0; i < 6; ++i) {
    const double level = torque(random);
    go_slowly(plant, level);
    spring.move_to_torque(level);
    // Of about 1e-4 rad: the last element stands for a wide cell of the distribution.
    EXPECT_NEAR(plant.theta(), spring.elongation(), 3e-7) << i;
  }
}

// In exact balance at rest no direction is ahead, in which an element could slip.
TEST(Gms, KeepsItsElementsIfNothingMovesThem) {
  GmsPlant alone({}, elements(gms_like_the_spring(), 0.8, 30.0), {}, gms_tolerance);
  GmsPlant beside({}, elements(gms_like_the_spring(), 0.8, 30.0), {}, gms_tolerance);
  motion::Disturbance disturbance;
  disturbance.ripple = {{0.0, 36.0, 0.0}};
  beside.disturb(disturbance);
  for (const double torque : {0.0, 0.01, -0.02, 0.25}) {
    alone.advance(motion::constant_torque(torque), 5e-4);
    beside.advance(motion::constant_torque(torque), 5e-4);
    EXPECT_FALSE(beside.sliding()) << torque;
    EXPECT_NEAR(beside.theta(), alone.theta(), 1e-13) << torque;
  }
}

// A slow torque before the start leaves the springs as the same torque applied slowly does.
TEST(Gms, StartsWithTheMemoryOfItsPreload) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 3; ++i) {
    const auto drawn = random_elements(random, 6);
    const motion::PlantParameters rotor{.sliding_damping = heavy_damping};
    const FrictionAlongRotor friction = elements(drawn, 1.0, 1e4);
    GmsPlant loaded(rotor, friction, {.preload = 0.2, .history = {-0.1, 0.15}}, gms_tolerance);
    GmsPlant virgin(rotor, friction, {}, gms_tolerance);
    for (const double torque : {0.2, 0.0, -0.1, 0.15, 0.0}) go_slowly(virgin, torque);
    EXPECT_EQ(loaded.theta(), 0.0);
    for (std::size_t e = 0; e < drawn.size(); ++e)
      EXPECT_NEAR(loaded.elements()[e].torque, virgin.elements()[e].torque, 1e-7);
  }
}

// Friction takes energy. The model gives a little: while ω falls, the torque of a slipping element rises to
// its level by itself, not by travel. An element that began to slip against its torque would give some sixty
// times as much.
TEST(Gms, IsPassiveExceptForTheRiseOfSlippingTorques) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> torque(0.0, 0.3);
  const motion::PlantParameters rotor;
  GmsPlant plant(rotor, elements({}, 0.6, 30.0), {}, gms_tolerance);
  const auto stored = [&] {
    double energy = 0.5 * rotor.inertia * plant.omega() * plant.omega();
    for (const GmsState& state : plant.elements())
      energy += 0.5 * state.torque * state.torque / state.stiffness;
    return energy;
  };
  double given = 0.0;
  double work = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double applied = torque(random);
    const double before = stored();
    const double from = plant.theta();
    plant.advance(motion::constant_torque(applied), 5e-4);
    const double input = applied * (plant.theta() - from);
    given += std::max(0.0, stored() - before - input);
    work += std::abs(input);
  }
  EXPECT_LT(given, 1e-4 * work);
}

}  // namespace
}  // namespace zerocount::friction
