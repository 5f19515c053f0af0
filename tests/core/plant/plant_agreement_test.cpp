// The plant against Boost.odeint, open loop: random torques, held or followed by a first-order amplifier, for
// every friction model and every kind of start. What a trial adds to it is tested with the trial.
#include "core/plant/plant.hpp"
#include "core/trial/open_loop.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/odeint_motion.hpp"
#include "tests/support/random_trials.hpp"
#include "tests/support/stop_elements.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// Course of the torque from one interval to the next.
enum class Drive { held, amplified, amplified_with_jumps };

struct Family {
  const char* name;
  TrialKind kind;
  Drive drive;
};

void PrintTo(const Family& family, std::ostream* out) {
  *out << family.name;
}

/// Random courses of the torque, interval by interval, for one machine.
class RandomDrive {
 public:
  RandomDrive(Draws& draws, const trial::TrialParameters& machine, Drive drive)
      : draws_(draws), drive_(drive), period_(1.0 / machine.controller.sample_rate) {
    const double breakaway = friction::friction_at(machine.friction, machine.initial.position).breakaway;
    largest_ = breakaway * (draws.chance(0.3) ? draws.log_uniform(0.03, 1.0) : draws.uniform(1.0, 3.0));
    wandering_ = draws.chance(0.5);
    course_.rate = drive == Drive::held ? 0.0 : draws.log_uniform(0.05, 100.0) / period_;
  }

  /// The course of the next interval, and how long it lasts (s).
  std::pair<motion::TorqueCourse, double> next() {
    const motion::TorqueCourse ended = motion::course_after(course_, duration_);
    const double step = (wandering_ ? 0.2 : 1.0) * largest_ * draws_.uniform(-1.0, 1.0);
    course_.settled = std::clamp(wandering_ ? course_.settled + step : step, -largest_, largest_);
    if (draws_.chance(0.1)) course_.settled = 0.0;
    if (draws_.chance(0.1)) course_.settled = ended.settled;
    course_.now = drive_ == Drive::held ? course_.settled : ended.now;
    if (drive_ == Drive::amplified_with_jumps && draws_.chance(0.3)) {
      course_.now = largest_ * draws_.uniform(-1.0, 1.0);
    }
    duration_ = period_ * (draws_.chance(0.5) ? 1.0 : draws_.log_uniform(0.01, 5.0));
    return {course_, duration_};
  }

 private:
  Draws& draws_;
  Drive drive_;
  double period_;
  double largest_;
  bool wandering_;
  double duration_{0.0};
  motion::TorqueCourse course_;
};

/// Largest differences of the rotor angle θ between two integrations, divided by the promised accuracy.
struct Differences {
  double before{0.0};  // until the first breakaway, counts
  double after{0.0};   // after it, proportion of 1e-3 count + 1e-7 of the travel
  std::int64_t intervals{0};
  std::int64_t sliding{0};
  EventCounts events{};
};

motion::PlantStart start_of(const trial::TrialParameters& p) {
  return {p.initial.position, p.initial.hardening,
          p.initial.preload,  trial::draw_history(p.initial.history, p.randomness),
          p.initial.velocity, p.initial.mode == trial::InitialMode::slide};
}

void compare_motion(const Family& family, std::uint64_t index, Differences& worst) {
  const trial::TrialParameters machine = random_trial(family.kind, 5000 + index);
  const std::string name = fmt::format("{} {}", family.name, index);
  const double count = 2.0 * std::numbers::pi / machine.encoder.fine;
  const motion::PlantStart start = start_of(machine);
  plant::Plant plant(machine.plant, machine.friction, start, {1e-11 * count});
  OdeintMotion judge(machine, start.history);
  ASSERT_EQ(plant.theta(), 0.0) << name;
  ASSERT_EQ(plant.sliding(), judge.sliding()) << name;
  ASSERT_EQ(plant.read().depth, judge.depth()) << name;
  Draws draws(77 + index);
  RandomDrive drive(draws, machine, family.drive);
  double travel = 0.0;
  for (int k = 0; k < 80; ++k) {
    const auto [course, duration] = drive.next();
    const long double before = judge.theta();
    plant.advance(course, duration);
    judge.advance({course.now, course.settled, course.rate}, duration);
    travel += std::abs(static_cast<double>(judge.theta() - before));
    const bool slid = judge.sliding() || judge.events().breakaways > 0 || judge.events().resticks > 0;
    const double allowed = slid ? 1e-3 * count + 1e-7 * travel : 1e-6 * count;
    const double difference = std::abs(static_cast<double>(plant.theta() - judge.theta()));
    ASSERT_LE(difference, allowed) << fmt::format("{} interval {}: {} counts apart", name, k,
                                                  difference / count);
    ASSERT_EQ(plant.sliding(), judge.sliding()) << name << " interval " << k;
    ASSERT_NEAR(plant.read().creep.extension, static_cast<double>(judge.state()[2]), allowed) << name;
    if (!plant.sliding()) {
      ASSERT_NEAR(plant.read().creep.hardening, static_cast<double>(judge.state()[3]), allowed) << name;
    }
    double& proportion = slid ? worst.after : worst.before;
    proportion = std::max(proportion, difference / (slid ? allowed : count));
    worst.intervals += 1;
    worst.sliding += plant.sliding();
  }
  ASSERT_TRUE(plant.finite());
  worst.events.breakaways += judge.events().breakaways;
  worst.events.reversals += judge.events().reversals;
  worst.events.closures += judge.events().closures;
}

class PlantAgreement : public ::testing::TestWithParam<Family> {};

TEST_P(PlantAgreement, EqualsBoostOdeint) {
  Differences worst;
  for (std::uint64_t index = 0; index < 40; ++index) compare_motion(GetParam(), index, worst);
  std::cout << fmt::format(
      "{}: {} intervals, {} sliding, {} breakaways, {} reversals; theta within {:.1e} count before "
      "breakaway, "
      "{:.1e} of the bound after\n",
      GetParam().name, worst.intervals, worst.sliding, worst.events.breakaways, worst.events.reversals,
      worst.before, worst.after);
  EXPECT_LT(worst.before, 1e-7);
  EXPECT_LT(worst.after, 0.1);
}

INSTANTIATE_TEST_SUITE_P(
    Random, PlantAgreement,
    ::testing::Values(Family{"presliding", TrialKind::breaking_away, Drive::held},
                      Family{"presliding_amplified", TrialKind::breaking_away, Drive::amplified},
                      Family{"presliding_with_jumps", TrialKind::calm, Drive::amplified_with_jumps},
                      Family{"other_machines_amplified", TrialKind::unlike_the_paper, Drive::amplified},
                      Family{"other_machines_with_jumps", TrialKind::unlike_the_paper,
                             Drive::amplified_with_jumps},
                      Family{"spring", TrialKind::spring_alone, Drive::held},
                      Family{"spring_amplified", TrialKind::spring_alone, Drive::amplified},
                      Family{"coulomb", TrialKind::coulomb, Drive::held},
                      Family{"coulomb_amplified", TrialKind::coulomb, Drive::amplified},
                      Family{"coulomb_with_jumps", TrialKind::coulomb, Drive::amplified_with_jumps},
                      Family{"arriving", TrialKind::arriving, Drive::held},
                      Family{"arriving_amplified", TrialKind::arriving, Drive::amplified},
                      Family{"remembering", TrialKind::remembering, Drive::held},
                      Family{"remembering_amplified", TrialKind::remembering, Drive::amplified}),
    [](const ::testing::TestParamInfo<Family>& family) { return std::string(family.param.name); });

// Energy: what the motor puts in is in the rotor and the spring, or has been dissipated, and never comes
// back.

constexpr double count = 2.0 * std::numbers::pi / 1620000;  // rad
constexpr double sample = 5e-4;                             // s
constexpr motion::MotionTolerance tolerance{1e-10 * count};

/// Follows the plant in short steps and adds up the energy that the torque supplies, and the energy that
/// damper and sliding friction dissipate.
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

  /// Advances the plant by one short step dt (s) and adds the energies, integrated by Simpson's rule.
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

/// Torque of sample k: torques that go forth and back beyond the breakaway torque, 400 samples in all.
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
TEST(HystereticEnergy, IsNeverRecovered) {
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
