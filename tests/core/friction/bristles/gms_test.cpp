// The generalised Maxwell-slip model: its memory, its levels, and its limits.
#include "core/friction/presliding/spring.hpp"
#include "core/plant/plant.hpp"
#include "tests/support/test.hpp"

namespace zerocount::friction {
namespace {

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

/// Takes the torque slowly from level to level, without sliding.
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
    // Of 1e-4: the last element stands for a wide cell.
    EXPECT_NEAR(plant.theta(), spring.elongation(), 3e-7) << i;
  }
}

// In exact balance at rest no direction is ahead, in which an element could slip.
TEST(Gms, KeepsItsElementsWhereNothingMovesThem) {
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
    for (std::size_t e = 0; e < drawn.size(); ++e) {
      EXPECT_NEAR(loaded.elements()[e].torque, virgin.elements()[e].torque, 1e-7);
    }
  }
}

// Friction takes energy. The model gives a little: while ω falls, the torque of a slipping element rises to
// its level by itself, not by travel. An element that began to slip against its torque would give some sixty
// times as much.
TEST(Gms, IsPassiveButForTheRiseOfSlippingTorques) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> torque(0.0, 0.3);
  const motion::PlantParameters rotor;
  GmsPlant plant(rotor, elements({}, 0.6, 30.0), {}, gms_tolerance);
  const auto stored = [&] {
    double energy = 0.5 * rotor.inertia * plant.omega() * plant.omega();
    for (const GmsState& state : plant.elements())
      energy += 0.5 * state.torque * state.torque / state.element.stiffness;
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
