// The rotor that comes to rest under a constant torque: against Boost.odeint, which follows every oscillation
// and all of the creep, and in pieces of any length.
#include "core/plant/plant.hpp"
#include "core/trial/machine.hpp"
#include "core/trial/trial.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/odeint_motion.hpp"
#include "tests/support/random_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using PreslidingPlant = plant::PlantWith<friction::PreslidingFriction>;

double count_of(const trial::TrialParameters& machine) {
  return 2.0 * std::numbers::pi / machine.encoder.fine;
}

/// The plant of a machine at the start of a trial, with the tolerances that trials use.
PreslidingPlant plant_of(const trial::TrialParameters& machine) {
  return {machine.plant, machine.friction, trial::plant_start(machine),
          trial::motion_tolerance(count_of(machine))};
}

struct Hold {
  double torque;    ///< torque that is held, N m
  double duration;  ///< duration of the hold, s
};

/// Random torques that do not break the contact away, each held until the oscillation has ended.
std::vector<Hold> random_holds(Draws& draws, const trial::TrialParameters& machine) {
  std::vector<Hold> holds;
  holds.reserve(3);
  const double breakaway = friction::friction_at(machine.friction, machine.initial.position).breakaway;
  for (int i = 0; i < 3; ++i)
    holds.push_back({0.3 * breakaway * draws.uniform(-1.0, 1.0), draws.uniform(0.2, 0.5)});
  return holds;
}

void hold(PreslidingPlant& plant, double torque, double duration) {
  plant.advance(motion::constant_torque(torque), duration);
}

/// Random machine `index`, like the paper's: with creep of every exponent, or without creep.
trial::TrialParameters machine_number(std::uint64_t index) {
  return random_trial(index % 4 == 0 ? TrialKind::spring_alone : TrialKind::calm, 9000 + index);
}

TEST(PlantAtRest, AgreesWithTheFullEquations) {
  double worst = 0.0;
  int rests = 0;
  for (std::uint64_t index = 0; index < 40; ++index) {
    const trial::TrialParameters machine = machine_number(index);
    Draws draws(index);
    PreslidingPlant plant = plant_of(machine);
    OdeintMotion judge(machine);
    for (const Hold& h : random_holds(draws, machine)) {
      for (double remaining = h.duration; remaining > 0.0;) {
        const double piece = std::min(remaining, draws.uniform(0.0, 0.05));
        hold(plant, h.torque, piece);
        judge.advance(h.torque, piece);
        remaining -= piece;
        worst =
            std::max(worst, std::abs(static_cast<double>(plant.theta() - judge.theta())) / count_of(machine));
      }
      rests += plant.come_to_rest(h.torque, false);
    }
    ASSERT_FALSE(plant.sliding() || judge.sliding()) << index;
  }
  std::cout << rests << " rests: theta within " << worst << " count\n";
  EXPECT_GT(rests, 60);
  EXPECT_LT(worst, 3e-8);
}

/// The agreement lasts as long as the creep: the closed form continues from one rest, and the judge
/// integrates.
TEST(PlantAtRest, AgreesWithTheFullEquationsForSeconds) {
  double worst = 0.0;
  for (std::uint64_t index = 0; index < 6; ++index) {
    trial::TrialParameters machine = machine_number(4 * index + 1);
    machine.friction.uniform.alpha = 0.3 + static_cast<double>(index);
    machine.initial.preload = machine.initial.hardening = 0.0;
    PreslidingPlant plant = plant_of(machine);
    OdeintMotion judge(machine);
    const double torque = 0.012 + 0.002 * static_cast<double>(index);
    double moved = 0.0;
    for (int i = 0; i < 30; ++i) {
      hold(plant, torque, 0.1);
      judge.advance(torque, 0.1);
      const double difference = std::abs(static_cast<double>(plant.theta() - judge.theta()));
      worst = std::max(worst, difference / count_of(machine));
      moved = plant.creep().extension / count_of(machine);
    }
    EXPECT_GT(moved, 0.1) << index;
  }
  std::cout << "theta within " << worst << " count\n";
  EXPECT_LT(worst, 3e-8);
}

/// The set of remembered reversals does not depend on how a hold is divided into pieces.
TEST(PlantAtRest, RemembersTheSameReversalsInPiecesOfAnyLength) {
  int holds = 0;
  std::int64_t deepest = 0;
  for (std::uint64_t index = 0; index < 120; ++index) {
    const trial::TrialParameters machine = machine_number(1000 + index);
    Draws draws(2000 + index);
    PreslidingPlant whole = plant_of(machine);
    PreslidingPlant samples = plant_of(machine);
    PreslidingPlant pieces = plant_of(machine);
    for (const Hold& h : random_holds(draws, machine)) {
      const int steps = static_cast<int>(h.duration / 5e-4);
      for (PreslidingPlant* plant : {&whole, &samples, &pieces}) plant->forget_deepest();
      hold(whole, h.torque, 5e-4 * steps);
      for (int k = 0; k < steps; ++k) {
        hold(samples, h.torque, 5e-4);
        const double part = draws.uniform(0.0, 5e-4);
        hold(pieces, h.torque, part);
        hold(pieces, h.torque, 5e-4 - part);
      }
      for (const PreslidingPlant* plant : {&samples, &pieces}) {
        EXPECT_EQ(plant->spring().depth(), whole.spring().depth()) << index;
        EXPECT_EQ(plant->deepest(), whole.deepest()) << index;
        EXPECT_NEAR(plant->theta(), whole.theta(), 3e-8 * count_of(machine)) << index;
      }
      deepest = std::max(deepest, whole.deepest());
      ++holds;
    }
  }
  std::cout << holds << " holds, up to " << deepest << " reversals\n";
  EXPECT_GT(deepest, 20);
}

TEST(PlantAtRest, IsNotReachedWhileTheRotorOscillates) {
  for (const double alpha : {0.0, 0.5}) {
    trial::TrialParameters machine;
    machine.friction.uniform.alpha = alpha;
    PreslidingPlant plant = plant_of(machine);
    EXPECT_FALSE(plant.come_to_rest(0.012, false));
    hold(plant, 0.012, 5e-4);
    EXPECT_FALSE(plant.come_to_rest(0.012, false));
    hold(plant, 0.012, 0.5);
    EXPECT_TRUE(plant.come_to_rest(0.012, false)) << alpha;
    EXPECT_FALSE(plant.come_to_rest(0.012 + 2.4e-4, false));
    EXPECT_FALSE(plant.come_to_rest(-0.012, false));
  }
}

/// Creep goes by a power of σ, so oscillations about a torque add more to it on one side than they take on
/// the other; and it recovers what it is ahead. With little damping and fast creep both are far from small.
TEST(PlantAtRest, WaitsIfOscillationsAddToCreep) {
  double worst = 0.0;
  for (std::uint64_t index = 0; index < 24; ++index) {
    Draws draws(3000 + index);
    trial::TrialParameters machine;
    friction::FrictionParameters& contact = machine.friction.uniform;
    const double stiffest = contact.k1 + contact.k2;
    const double ratio = std::exp(draws.uniform(std::log(0.01), std::log(0.1)));  // of damping
    machine.plant.presliding_damping = 2.0 * ratio * std::sqrt(stiffest * machine.plant.inertia);
    contact.alpha = std::exp(draws.uniform(std::log(0.1), std::log(10.0)));
    contact.n = index % 3 == 0 ? 1.0 : (index % 3 == 1 ? 2.0 : 2.7);
    const double torque = 0.004 * draws.uniform(0.5, 1.0);
    // Creep of 10 to 3000 counts.
    const double creep = std::exp(draws.uniform(std::log(10.0), std::log(3000.0))) * count_of(machine);
    contact.lambda = std::pow(torque, contact.n) / creep;
    PreslidingPlant plant = plant_of(machine);
    OdeintMotion judge(machine);
    for (int i = 0; i < 60; ++i) {
      hold(plant, torque, 0.01);
      judge.advance(torque, 0.01);
      const double difference = std::abs(static_cast<double>(plant.theta() - judge.theta()));
      worst = std::max(worst, difference / count_of(machine));
    }
  }
  std::cout << "theta within " << worst << " count\n";
  EXPECT_LT(worst, 3e-8);
}

/// A slow ramp is a stair of steps each smaller than what counts as rest; the spring remembers its turns all
/// the same.
TEST(PlantAtRest, RemembersASlowUnloading) {
  for (const double direction : {1.0, -1.0}) {
    trial::TrialParameters machine;
    machine.encoder.fine = 10000;
    machine.friction.uniform.alpha = 0.0;
    PreslidingPlant plant = plant_of(machine);
    hold(plant, direction * 0.05, 1.0);
    friction::HystereticSpring spring = plant.spring();
    const double before = spring.elongation();
    constexpr int steps = 20000;
    for (const double way : {-1.0, 1.0, -1.0}) {
      const double from = way < 0.0 ? 0.05 : 0.05 - 1e-5;
      for (int k = 1; k <= steps; ++k) hold(plant, direction * (from + way * 1e-5 * k / steps), 5e-4);
      spring.move_to_torque(direction * (from + way * 1e-5));
      EXPECT_NEAR(plant.theta(), spring.elongation(), 1e-7 * count_of(machine));
    }
    EXPECT_LT(direction * (spring.elongation() - before), -1e-9);
  }
}

TEST(PlantAtRest, CreepsInOneDirection) {
  for (std::uint64_t index = 0; index < 20; ++index) {
    trial::TrialParameters machine = machine_number(4 * index + 1);
    Draws draws(index);
    PreslidingPlant plant = plant_of(machine);
    const double torque = 0.02 * draws.uniform(0.3, 1.0) * (index % 2 == 0 ? 1.0 : -1.0);
    hold(plant, torque, 0.5);
    if (!plant.come_to_rest(torque, false)) continue;
    double theta = plant.theta();
    for (int k = 0; k < 2000; ++k) {
      hold(plant, torque, 5e-4);
      ASSERT_GE((plant.theta() - theta) * torque, 0.0) << index << " sample " << k;
      theta = plant.theta();
    }
  }
}

/// Creep as fast as the oscillation decays: no slow motion is left when they have, and yet rounding must not
/// make the spring reverse for ever.
TEST(PlantAtRest, IsReachedHoweverFastItCreeps) {
  std::vector<std::uint64_t> indices{500366, 501150};  // found among thousands
  for (std::uint64_t index = 0; index < 150; ++index) indices.push_back(510000 + index);
  for (const std::uint64_t index : indices) {
    trial::TrialParameters p = random_trial(TrialKind::calm, index);
    friction::FrictionParameters& f = p.friction.uniform;
    f.lambda = 4e-4 / friction::hardening_limit(f, 0.02);
    f.n = 2.0;
    p.friction.profiled.clear();
    const auto i = static_cast<double>(index % 200);
    f.alpha = std::exp(3.0 + 0.015 * i);  // 20 to 400 /s
    f.lambda *= std::exp(0.02 * std::fmod(37.0 * i, 200.0) - 2.0);
    for (const trial::MoveOutcome& move : trial::run_trial(p).moves) {
      EXPECT_NE(move.outcome, trial::Outcome::nonfinite) << index;
      EXPECT_LT(move.reversal_depth, 200) << index;
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
