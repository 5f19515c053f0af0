// Creep at rest in closed form, against the full equations of motion integrated by Boost.odeint in 64-bit
// mantissas, over random machines.
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "core/friction/presliding/creep.hpp"
#include "core/friction/presliding/spring.hpp"
#include "tests/support/test.hpp"

namespace zerocount::friction {
namespace {

using Real = long double;

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(engine_() >> 11), -53);
  }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  template <class T, std::size_t size>
  T any_of(const T (&choices)[size]) {
    return choices[engine_() % size];
  }

 private:
  std::mt19937_64 engine_;
};

/// A rotor that creeps under a constant torque, on a branch of its spring.
struct CreepingRotor {
  motion::PlantParameters plant;
  FrictionParameters contact;
  SpringBranch branch;  ///< branch of the spring, which starts at the elongation xr = 0
  double torque;        ///< constant torque u, N m
  double sign;
  double start;      ///< elongation xs of the spring at t = 0, rad
  double hardening;  ///< hardening xh at t = 0, rad
  CreepAtRest creep;
  double bound;  ///< computed bound of the error of θ, rad
};

Real branch_torque(const SpringBranch& b, Real x) {
  const Real travel = b.sign * x;
  return b.torque + b.sign * (b.k1 * travel - b.softening_torque * std::expm1(-b.softening_rate * travel));
}

/// The elongation at which the branch of the spring carries the torque, by Newton's method from `near`.
Real branch_elongation(const SpringBranch& b, Real torque, Real near) {
  Real x = near;
  for (int i = 0; i < 60; ++i) {
    const Real travel = b.sign * x;
    const Real stiffness =
        b.k1 + b.softening_torque * b.softening_rate * std::exp(-b.softening_rate * travel);
    x += (torque - branch_torque(b, x)) / stiffness;
  }
  return x;
}

/// A random creeping rotor of any size and damping. Its creep is as fast as the formula allows, or up to 30
/// times slower.
/// @param softening whether the spring softens noticeably on the way
CreepingRotor random_rotor(Draws& draws, bool softening) {
  constexpr double exponents[] = {1.0, 1.2, 1.5, 2.0, 2.7, 3.0};
  for (;;) {
    CreepingRotor r{};
    r.sign = draws.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
    const double stiffness = draws.log_uniform(20.0, 5000.0);
    r.plant.inertia = draws.log_uniform(5e-5, 5e-2);
    r.plant.presliding_damping = 2.0 * draws.log_uniform(0.1, 3.0) * std::sqrt(stiffness * r.plant.inertia);
    const double oscillation = std::min(r.plant.presliding_damping / (2.0 * r.plant.inertia),
                                        stiffness / r.plant.presliding_damping);
    FrictionParameters& f = r.contact;
    f.alpha = 0.1 * oscillation * draws.log_uniform(0.03, 1.0);
    f.n = draws.any_of(exponents);
    r.torque = r.sign * draws.log_uniform(1e-3, 0.5);
    f.lambda = std::pow(std::abs(r.torque), f.n) / draws.log_uniform(1e-7, 3e-4);
    r.branch.sign = r.sign;
    r.branch.k1 = softening ? stiffness * draws.uniform(0.2, 0.9) : stiffness;
    r.branch.softening_rate = softening ? draws.log_uniform(1e3, 1e6) : 1.0;
    r.branch.softening_torque =
        softening ? draws.log_uniform(0.01, 1.0) * stiffness / r.branch.softening_rate : 0.0;
    f.k1 = r.branch.k1;
    f.k2 = r.branch.softening_torque * r.branch.softening_rate;
    f.beta = r.branch.softening_rate;

    const double limit = hardening_limit(f, r.torque);
    const double hardening = limit * (1.0 - draws.log_uniform(1e-3, 0.9));
    const Real balanced = branch_elongation(r.branch, r.torque, 0);
    // The stiffness where the motion starts is not known before it is: twice is enough.
    double tangent = stiffness_on(r.branch, static_cast<double>(balanced));
    std::optional<CreepAtRest> creep;
    for (int round = 0; round < 20; ++round) {
      creep = creep_at_rest(r.plant, f, r.torque, r.sign, tangent, hardening);
      if (!creep) break;
      r.start = static_cast<double>(
          branch_elongation(r.branch, r.sign * spring_torque_at_rate(*creep, creep->rate), balanced));
      tangent = stiffness_on(r.branch, r.start);
    }
    if (!creep || spring_torque_at_rate(*creep, creep->rate) <= 0.0 || r.sign * r.start < 0.0) continue;
    r.creep = *creep;
    r.hardening = hardening;
    const double last = stiffness_on(r.branch, static_cast<double>(balanced));
    r.bound = error_of_creep_at_rest(r.creep, r.plant, f, tangent, std::min(last, tangent));
    return r;
  }
}

using State = std::array<Real, 3>;  // xs, ω, xh

struct Motion {
  const CreepingRotor& r;
  void operator()(const State& y, State& dydt, Real) const {
    const Real torque = branch_torque(r.branch, y[0]);
    const Real rate =
        r.contact.alpha * (std::pow(std::abs(torque), Real(r.contact.n)) / r.contact.lambda - y[2]);
    dydt = {y[1] - r.sign * rate, (r.torque - r.plant.presliding_damping * y[1] - torque) / r.plant.inertia,
            rate};
  }
};

struct Deviations {
  double theta{0.0};      // rad
  double hardening{0.0};  // rad
};

/// Largest deviations of the closed form from the numerical integration while the creep dies out to 1/150 of
/// its rate.
Deviations largest_deviations(const CreepingRotor& r) {
  namespace odeint = boost::numeric::odeint;
  using Stepper = odeint::runge_kutta_fehlberg78<State, Real, State, Real>;
  const double first_torque = r.sign * spring_torque_at_rate(r.creep, r.creep.rate);
  State y{branch_elongation(r.branch, first_torque, r.start),
          r.sign * velocity_at_rate(r.creep, r.creep.rate), r.hardening};
  const State begin = y;
  Deviations worst;
  constexpr int instants = 25;
  const Real part = Real(5.0) / r.creep.g1 / instants;
  for (int i = 1; i <= instants; ++i) {
    odeint::integrate_adaptive(odeint::make_controlled<Stepper>(Real(1e-20), Real(1e-16)), Motion{r}, y,
                               Real(0), part, part / 100);
    const double rate = creep_rate_after(r.creep, static_cast<double>(part * i));
    const double growth = creep_until_rate(r.creep, rate);
    const Real x = branch_elongation(r.branch, r.sign * spring_torque_at_rate(r.creep, rate), y[0]);
    const Real theta = x - begin[0] + r.sign * growth;
    const Real exact = y[0] - begin[0] + r.sign * (y[2] - begin[2]);
    worst.theta = std::max(worst.theta, static_cast<double>(std::abs(theta - exact)));
    worst.hardening = std::max(worst.hardening, static_cast<double>(std::abs(growth - (y[2] - begin[2]))));
  }
  return worst;
}

class CreepAtRestFormula : public ::testing::TestWithParam<bool> {};

INSTANTIATE_TEST_SUITE_P(Spring, CreepAtRestFormula, ::testing::Values(false, true));

TEST_P(CreepAtRestFormula, StaysWithinItsErrorBound) {
  Draws draws(GetParam() ? 12 : 11);
  double closest = 0.0;
  int noticeable = 0;
  for (int i = 0; i < 60; ++i) {
    const CreepingRotor r = random_rotor(draws, GetParam());
    const Deviations found = largest_deviations(r);
    // Of the closed form, and of the integration.
    const double rounding =
        1e-19 + 2e-15 * (r.creep.rate / r.creep.g1 + std::abs(r.torque) / stiffness_on(r.branch, r.start));
    EXPECT_LE(found.theta, r.bound + rounding) << "rotor " << i << ", n " << r.contact.n;
    EXPECT_LE(found.hardening, r.bound + rounding) << "rotor " << i << ", n " << r.contact.n;
    if (r.bound < 10.0 * rounding) continue;
    ++noticeable;
    closest = std::max(closest, found.theta / r.bound);
  }
  std::cout << noticeable << " of 60 rotors with a noticeable error: up to " << closest << " of the bound\n";
  EXPECT_GT(noticeable, 12);
}

TEST(CreepAtRest, IsTheIntegralOfItsRate) {
  Draws draws(13);
  for (int i = 0; i < 100; ++i) {
    const CreepAtRest creep = random_rotor(draws, true).creep;
    const double time = draws.uniform(0.01, 5.0) / creep.g1;
    const double growth = boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
        [&](double t) { return creep_rate_after(creep, t); }, 0.0, time, 10, 1e-14);
    EXPECT_NEAR(creep_until_rate(creep, creep_rate_after(creep, time)), growth, 1e-11 * growth) << i;
  }
}

TEST(CreepAtRest, ItsFunctionsAreInverse) {
  Draws draws(14);
  for (int i = 0; i < 1000; ++i) {
    CreepAtRest creep = random_rotor(draws, true).creep;
    if (i % 5 == 0) creep.g2 = 0.0;
    if (i % 5 == 1) creep.g2 = draws.uniform(-0.3, 0.5) * creep.g1 / creep.rate;  // far from small
    const double rate = creep.rate * draws.uniform(0.01, 1.0);
    const double time = draws.uniform(0.0, 5.0) / creep.g1;
    EXPECT_NEAR(rate_after_creep(creep, creep_until_rate(creep, rate)), rate, 1e-12 * creep.rate) << i;
    EXPECT_NEAR(creep_rate_after(creep, time_until_rate(creep, rate)), rate, 1e-12 * creep.rate) << i;
    EXPECT_NEAR(time_until_rate(creep, creep_rate_after(creep, time)), time, 1e-11 / creep.g1) << i;
    EXPECT_EQ(creep_until_rate(creep, creep.rate), 0.0);
    EXPECT_NEAR(creep_rate_after(creep, 0.0), creep.rate, 1e-13 * creep.rate);
  }
}

TEST(CreepAtRest, NeverExceedsTheRemainingExtension) {
  Draws draws(15);
  for (int i = 0; i < 200; ++i) {
    const CreepAtRest creep = random_rotor(draws, i % 2 == 0).creep;
    const double all = creep_until_rate(creep, 0.0);
    EXPECT_LE(rate_after_creep(creep, all * 1.0001), 0.0) << i;
    EXPECT_GT(rate_after_creep(creep, all * 0.9999), 0.0) << i;
  }
}

TEST(CreepAtRest, IsNotUsedIfCreepIsAsFastAsTheOscillation) {
  const motion::PlantParameters plant;
  FrictionParameters contact;
  const double stiffness = 860.0;
  const double oscillation =
      std::min(plant.presliding_damping / (2.0 * plant.inertia), stiffness / plant.presliding_damping);
  contact.alpha = 0.0999 * oscillation;
  EXPECT_TRUE(creep_at_rest(plant, contact, 0.02, 1.0, stiffness, 0.0));
  EXPECT_TRUE(creep_at_rest(plant, contact, -0.02, -1.0, stiffness, 0.0));
  contact.alpha = 0.1001 * oscillation;
  EXPECT_FALSE(creep_at_rest(plant, contact, 0.02, 1.0, stiffness, 0.0));
}

// The plastic module: its exact solution at constant torque, and the rules of the paper's Fig. 6.

constexpr double long_time = 1e3;  // s, many relaxation times

TEST(Creep, RelaxesExponentiallyToTheHardeningLimit) {
  const FrictionParameters friction;
  const double limit = hardening_limit(friction, 0.05);
  EXPECT_DOUBLE_EQ(limit, 0.05 * 0.05 / 10.0);
  for (const double t : {0.0, 0.1, 1.0, 5.0}) {
    const CreepState state = creep_at_constant_torque(friction, {}, 0.05, t);
    EXPECT_NEAR(state.hardening, limit * (1.0 - std::exp(-0.5 * t)), 1e-18);
    EXPECT_EQ(state.extension, state.hardening);
  }
}

TEST(Creep, IsTheSameInOneStepOrMany) {
  const FrictionParameters friction;
  CreepState state;
  for (int i = 0; i < 1000; ++i) state = creep_at_constant_torque(friction, state, -0.08, 0.003);
  EXPECT_NEAR(state.extension, creep_at_constant_torque(friction, {}, -0.08, 3.0).extension, 1e-17);
}

TEST(Creep, NeedsMoreTorqueThanItWasHardenedWith) {
  const FrictionParameters friction;
  const CreepState hardened = creep_at_constant_torque(friction, {}, 0.1, long_time);
  for (const double torque : {0.1, 0.05, 0.0, -0.05, -0.0999999}) {
    const CreepState after = creep_at_constant_torque(friction, hardened, torque, long_time);
    EXPECT_NEAR(after.extension, hardened.extension, 1e-12) << torque;  // unloading gives nothing back
  }
  EXPECT_GT(creep_at_constant_torque(friction, hardened, 0.12, long_time).extension, hardened.extension);
}

TEST(Creep, ALargerOppositeTorqueCreepsBackAndHardensFurther) {
  const FrictionParameters friction;
  const CreepState hardened = creep_at_constant_torque(friction, {}, 0.1, long_time);
  const CreepState back = creep_at_constant_torque(friction, hardened, -0.12, long_time);
  EXPECT_LT(back.extension, hardened.extension);
  EXPECT_NEAR(back.hardening, 0.12 * 0.12 / 10.0, 1e-12);
  EXPECT_NEAR(hardened.extension - back.extension, back.hardening - hardened.hardening, 1e-15);
}

TEST(Creep, OnsetTorqueInvertsTheHardeningLimit) {
  FrictionParameters friction;
  for (const double n : {1.0, 1.5, 2.0, 3.7}) {
    friction.n = n;
    EXPECT_NEAR(torque_of_limit(friction, hardening_limit(friction, -0.07)), 0.07, 1e-15);
  }
}

TEST(Creep, NeverSetsInIfItsRateIsZero) {
  FrictionParameters friction;
  friction.alpha = 0.0;
  EXPECT_TRUE(std::isinf(creep_onset_torque(friction, 0.0)));
}

}  // namespace
}  // namespace zerocount::friction
