// Energy: what the motor puts in is in the rotor and the spring, or has been dissipated, and never comes
// back.
#include "core/plant/plant.hpp"
#include "tests/support/stop_elements.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

constexpr double count = 2.0 * std::numbers::pi / 1620000;  // rad
constexpr double sample = 5e-4;                             // s
constexpr motion::MotionTolerance tolerance{1e-10 * count};

/// Follows the plant in short steps and adds up the energy that the torque brings, and that damper and
/// sliding friction take.
struct EnergyLedger {
  motion::PlantParameters rotor;
  friction::FrictionParameters friction;
  double work{0.0};        // by the torque, J
  double dissipated{0.0};  // by the dampers and sliding friction, J

  double loss_power(const auto& plant) const {
    const double omega = plant.omega();
    if (!plant.sliding()) return rotor.presliding_damping * omega * omega;
    const double coulomb = friction.coulomb_ratio * friction.breakaway;
    const double r = omega / friction.stribeck_velocity;
    return std::abs(omega) * (coulomb + (friction.breakaway - coulomb) * std::exp(-r * r)) +
           rotor.sliding_damping * omega * omega;
  }

  double kinetic(const auto& plant) const { return 0.5 * rotor.inertia * plant.omega() * plant.omega(); }

  /// One short step, by Simpson's rule.
  motion::TorqueCourse step(auto& plant, const motion::TorqueCourse& course, double dt) {
    const motion::TorqueCourse middle = motion::course_after(course, 0.5 * dt);
    const motion::TorqueCourse end = motion::course_after(course, dt);
    const auto sum = [&](double a, double b, double c) { return dt / 6.0 * (a + 4.0 * b + c); };
    const double loss = loss_power(plant);
    const double power = course.now * plant.omega();
    const double theta = plant.theta();
    plant.advance(course, 0.5 * dt);
    const double middle_loss = loss_power(plant);
    const double middle_power = middle.now * plant.omega();
    plant.advance(middle, 0.5 * dt);
    dissipated += sum(loss, middle_loss, loss_power(plant));
    work += motion::is_constant(course) ? course.now * (plant.theta() - theta)
                                        : sum(power, middle_power, end.now * plant.omega());
    return end;
  }
};

friction::FrictionAlongRotor of_model(friction::FrictionModel model, friction::FrictionParameters friction) {
  return {friction, {}, model};
}

/// Torques that go forth and back through the breakaway, 400 samples in all.
double alternating(int k) {
  return (k / 20) % 2 == 0 ? 0.15 : -0.12;
}

// With k2 → 0 the spring is elastic: stored energy σ²/2k1, the same before a slide and after it because the
// new contact carries the torque of the old one.
friction::FrictionParameters elastic() {
  friction::FrictionParameters friction;
  friction.k1 = 400.0;
  friction.k2 = 1e-9;
  friction.breakaway = 0.1;
  return friction;
}

struct LoopDrive {
  double rate;  // of the amplifier, 1/s; 0: none
  motion::PlantStart start;
};

class EnergyBalance : public ::testing::TestWithParam<LoopDrive> {};

TEST_P(EnergyBalance, HoldsThroughBreakawayAndReStickOnAnElasticSpring) {
  EnergyLedger ledger;
  ledger.friction = elastic();
  const motion::PlantStart& start = GetParam().start;
  plant::PlantWith<friction::SpringFriction> plant(
      ledger.rotor, of_model(friction::FrictionModel::spring, ledger.friction), start, tolerance);
  const auto stored = [&](double torque) { return 0.5 * torque * torque / ledger.friction.k1; };
  // A slide begins with the spring at the breakaway torque.
  const double at_start = ledger.kinetic(plant) + stored(start.sliding ? ledger.friction.breakaway : 0.0);
  double largest = at_start;
  motion::TorqueCourse course{0.0, 0.0, GetParam().rate};
  for (int k = 0; k < 400; ++k) {
    course.settled = alternating(k);
    if (course.rate == 0.0) course.now = course.settled;
    for (int i = 0; i < 250; ++i) course = ledger.step(plant, course, sample / 250);
    if (plant.sliding()) continue;  // nobody knows the spring
    largest = std::max(largest, std::abs(ledger.work));
    const double inside = ledger.kinetic(plant) + stored(plant.spring().torque());
    EXPECT_NEAR(at_start + ledger.work, inside + ledger.dissipated, 2e-5 * largest) << k;
  }
  EXPECT_GE(plant.breakaways(), 15);
}

TEST_P(EnergyBalance, HoldsUnderCoulombFriction) {
  EnergyLedger ledger;
  ledger.friction = elastic();
  plant::Plant plant(ledger.rotor, of_model(friction::FrictionModel::coulomb, ledger.friction),
                     GetParam().start, tolerance);
  const double at_start = ledger.kinetic(plant);
  double largest = at_start;
  motion::TorqueCourse course{0.0, 0.0, GetParam().rate};
  for (int k = 0; k < 400; ++k) {
    course.settled = alternating(k);
    if (course.rate == 0.0) course.now = course.settled;
    for (int i = 0; i < 250; ++i) course = ledger.step(plant, course, sample / 250);
    largest = std::max(largest, std::abs(ledger.work));
    EXPECT_NEAR(at_start + ledger.work, ledger.kinetic(plant) + ledger.dissipated, 2e-5 * largest) << k;
  }
  EXPECT_GE(plant.breakaways(), 10);
}

INSTANTIATE_TEST_SUITE_P(Drives, EnergyBalance,
                         ::testing::Values(LoopDrive{0.0, {}}, LoopDrive{400.0, {}}, LoopDrive{20000.0, {}},
                                           LoopDrive{0.0, {.velocity = 0.3}},
                                           LoopDrive{400.0, {.velocity = -0.5, .sliding = true}}));

// The energy of the hysteretic spring is that of its stop elements. What is neither there, nor in the rotor
// or the damper, is lost to hysteresis and creep, and that only grows.
TEST(HystereticEnergy, IsLostAndNeverComesBack) {
  std::mt19937 random(41);
  std::normal_distribution<double> torque(0.0, 0.06);
  for (const double alpha : {0.0, 20.0}) {
    for (const double rate : {0.0, 800.0}) {
      EnergyLedger ledger;
      ledger.friction.alpha = alpha;
      ledger.friction.breakaway = 10.0;
      plant::PlantWith<friction::PreslidingFriction> plant(
          ledger.rotor, of_model(friction::FrictionModel::presliding, ledger.friction), {}, tolerance);
      StopElements spring(ledger.friction, 2000);
      motion::TorqueCourse course{0.0, 0.0, rate};
      double lost = 0.0;
      double largest = 0.0;
      for (int k = 0; k < 60; ++k) {
        course.settled = torque(random);
        if (course.rate == 0.0) course.now = course.settled;
        for (int i = 0; i < 200; ++i) {
          course = ledger.step(plant, course, sample / 200);
          spring.move_to(plant.spring().elongation());
        }
        largest = std::max(largest, std::abs(ledger.work));
        const double now_lost = ledger.work - ledger.kinetic(plant) - ledger.dissipated - spring.energy();
        EXPECT_GE(now_lost, lost - 1e-4 * largest) << k;
        lost = now_lost;
      }
      EXPECT_GT(lost, 0.05 * ledger.work);
      EXPECT_LT(lost, ledger.work);
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
