// A small oscillation in closed form: against the exact solution of their linear equations by a matrix
// exponential, and by what they must be consistent with in themselves.
#include "core/friction/presliding/residual_oscillation.hpp"

#include <Eigen/Core>
#include <unsupported/Eigen/MatrixFunctions>

#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// An oscillating rotor with the inertia J = 1, because only c/J and k/J matter.
struct Rotor {
  double damping;    // c/J, 1/s
  double stiffness;  // k/J, 1/s²
  double creep;      // ξ, 1/s
};

class Draws {
 public:
  explicit Draws(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

 private:
  std::mt19937_64 engine_;
};

Rotor random_rotor(Draws& draws) {
  const double frequency = std::exp(draws.uniform(4.0, 9.0));
  return {frequency * draws.uniform(0.01, 1.2), frequency * frequency, frequency * draws.uniform(0.0, 0.05)};
}

friction::OscillationLaw law_of(const Rotor& rotor, double softening) {
  const double decay = 0.5 * (rotor.damping + rotor.creep);
  const double per_time_squared = rotor.stiffness + rotor.damping * rotor.creep;
  return {decay, std::sqrt(per_time_squared - decay * decay), rotor.creep, softening};
}

constexpr double notice = 1e-30;

TEST(ResidualOscillation, SolvesItsEquationsForALinearSpring) {
  Draws draws(1);
  for (int i = 0; i < 200; ++i) {
    const Rotor rotor = random_rotor(draws);
    const double per_time = std::sqrt(rotor.stiffness);
    const double q0 = draws.uniform(-1.0, 1.0);
    const double v0 = draws.uniform(-1.0, 1.0);
    const friction::ResidualOscillation oscillation =
        friction::residual_oscillation(law_of(rotor, 0.0), q0, v0 * per_time, notice);
    // In units of √(J/k): q, v, and what creep still has to come to, de/dt = ξ·q with e → 0.
    const double creep = rotor.creep / per_time;
    Eigen::Matrix3d law;
    law << -creep, 1.0, 0.0, -1.0, -rotor.damping / per_time, 0.0, creep, 0.0, 0.0;
    const Eigen::Vector3d start(q0, v0, friction::oscillation_at(oscillation, 0.0).extension);
    const double time = draws.uniform(0.0, 8.0);
    const Eigen::Vector3d exact = (law * time).exp() * start;
    const friction::ResidualOscillation::State state = friction::oscillation_at(oscillation, time / per_time);
    EXPECT_NEAR(state.elongation, exact(0), 1e-12) << i;
    EXPECT_NEAR(state.velocity / per_time, exact(1), 1e-12) << i;
    EXPECT_NEAR(state.extension, exact(2), 1e-12) << i;
  }
}

TEST(ResidualOscillation, PositionIsTheIntegralOfItsVelocity) {
  Draws draws(2);
  for (int i = 0; i < 200; ++i) {
    const Rotor rotor = random_rotor(draws);
    const friction::ResidualOscillation oscillation =
        friction::residual_oscillation(law_of(rotor, draws.uniform(0.0, 1e-3)), 1.0, 0.0, notice);
    const double period = 1.0 / std::sqrt(rotor.stiffness);
    const double time = draws.uniform(0.1, 8.0) * period;
    const double step = 1e-4 * period;
    const friction::ResidualOscillation::State before = friction::oscillation_at(oscillation, time - step);
    const friction::ResidualOscillation::State after = friction::oscillation_at(oscillation, time + step);
    const friction::ResidualOscillation::State now = friction::oscillation_at(oscillation, time);
    const double rate = (after.elongation - before.elongation) / (2.0 * step);
    EXPECT_NEAR(now.velocity, rate + rotor.creep * now.elongation, 1e-5 / period) << i;
  }
}

/// A cycle of amplitude a costs 4/3·k2·β·a³, the area of a closed loop of the spring to that order (Masing).
TEST(ResidualOscillation, LosesTheHysteresisEnergyPerCycle) {
  const Rotor rotor{1e-9, 1e6, 0.0};
  const double softening = 1e-4;  // k2·β/k, with a = 1
  const friction::ResidualOscillation oscillation =
      friction::residual_oscillation(law_of(rotor, softening), 1.0, 0.0, notice);
  const double period = 2.0 * std::numbers::pi / 1e3;
  const double left = friction::oscillation_at(oscillation, period / (1.0 - 0.5 * softening)).elongation;
  const double energy_lost = 0.5 * rotor.stiffness * (1.0 - left * left);
  EXPECT_NEAR(energy_lost / (4.0 / 3.0 * softening * rotor.stiffness), 1.0, 1e-3);
}

/// The stiffness between the ends of a loop of peak-to-peak 2a is k − k2·β·a to that order.
TEST(ResidualOscillation, IsSlowerTheLargerItIs) {
  const Rotor rotor{1e-9, 1e6, 0.0};
  const double softening = 1e-4;
  const friction::ResidualOscillation oscillation =
      friction::residual_oscillation(law_of(rotor, softening), 1.0, 0.0, notice);
  const double quarter = 0.5 * std::numbers::pi / std::sqrt(rotor.stiffness * (1.0 - softening));
  EXPECT_NEAR(friction::oscillation_at(oscillation, quarter).elongation, 0.0, 1e-8);
}

TEST(ResidualOscillation, StaysWithinItsBoundAndEnds) {
  Draws draws(3);
  for (int i = 0; i < 200; ++i) {
    const Rotor rotor = random_rotor(draws);
    const friction::ResidualOscillation oscillation =
        friction::residual_oscillation(law_of(rotor, draws.uniform(0.0, 1e-3)), draws.uniform(-1.0, 1.0),
                                       draws.uniform(-1.0, 1.0) * std::sqrt(rotor.stiffness), 1e-6);
    for (int k = 0; k < 50; ++k) {
      const double time = draws.uniform(0.0, 1.2) * oscillation.end;
      const double later = time + draws.uniform(0.0, 1.0) / std::sqrt(rotor.stiffness);
      const friction::ResidualOscillation::State state = friction::oscillation_at(oscillation, later);
      EXPECT_LE(std::abs(state.elongation + state.extension), friction::oscillation_bound(oscillation, time))
          << i;
    }
    EXPECT_LT(std::abs(friction::oscillation_at(oscillation, oscillation.end * (1.0 - 1e-9)).elongation),
              1.001e-6);
    EXPECT_EQ(friction::oscillation_at(oscillation, oscillation.end).elongation, 0.0);
  }
}

}  // namespace
}  // namespace zerocount::testing
