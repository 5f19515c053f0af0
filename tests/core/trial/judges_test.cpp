// The judge of the friction loop against closed forms, before it judges anything else.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/odeint_motion.hpp"

namespace zerocount::testing {
namespace {

// Under a constant torque U the rotor comes to rest with the spring carrying U less the damper's proportion,
// and creep follows xh(t) = (|U|ⁿ/λ)·(1 − exp(−αt)). A stiff, well damped rotor brings the start-up to
// nothing.
TEST(OdeintMotion, CreepsExactlyAtConstantTorque) {
  trial::TrialParameters parameters;
  parameters.plant = {1e-6, 0.02, 1e-3};
  for (const double n : {1.0, 1.5, 2.0, 3.0}) {
    parameters.friction.uniform.n = n;
    parameters.friction.uniform.lambda = std::pow(0.05, n) / 2e-5;
    OdeintMotion motion(parameters);
    for (int k = 0; k < 600; ++k) motion.advance(-0.05L, 5e-4L);
    const friction::FrictionParameters& f = parameters.friction.uniform;
    const double expected = 2e-5 * -std::expm1(-f.alpha * 0.3);
    EXPECT_NEAR(static_cast<double>(motion.state()[3]) / expected, 1.0, 2e-3);
    EXPECT_DOUBLE_EQ(static_cast<double>(motion.state()[2]), -static_cast<double>(motion.state()[3]));
  }
}

// A slide without damping and with coulomb_ratio 1 has the constant friction Fs: while it lasts, uniform
// acceleration.
TEST(OdeintMotion, SlidesUniformlyUnderCoulombFriction) {
  trial::TrialParameters parameters;
  parameters.plant.sliding_damping = 0.0;
  parameters.friction.uniform.coulomb_ratio = 1.0;
  OdeintMotion motion(parameters);
  while (!motion.sliding()) motion.advance(0.45L, 1e-4L);
  const long double speed = motion.state()[1];
  const long double start = motion.theta();
  motion.advance(0.45L, 0.01L);
  const long double acceleration = (0.45L - 0.3) / 5.54e-4;
  EXPECT_NEAR(static_cast<double>(motion.state()[1]), static_cast<double>(speed + acceleration * 0.01L),
              1e-12);
  EXPECT_NEAR(static_cast<double>(motion.theta() - start),
              static_cast<double>(speed * 0.01L + acceleration * 0.00005L), 1e-13);
}

}  // namespace
}  // namespace zerocount::testing
