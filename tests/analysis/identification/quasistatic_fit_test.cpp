// The spring that the slow parts are fitted with is that of stop elements, which need no rules of reversal.
#include "analysis/identification/quasistatic_fit.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/analysis/identification/material_tests.hpp"
#include "tests/support/stop_elements.hpp"

namespace zerocount::testing {
namespace {

TEST(SpringElongations, AreThoseOfStopElements) {
  std::mt19937_64 random(91);
  for (int round = 0; round < 20; ++round) {
    const friction::FrictionParameters friction = random_contact(random).friction;
    std::normal_distribution<double> torque(0.0, 0.1);
    std::vector<double> torques;
    for (int i = 0; i < 30; ++i) torques.push_back(torque(random));
    StopElements judge(friction, 2000);
    const std::vector<double> elongations = identification::spring_elongations(torques, friction);
    for (std::size_t i = 0; i < torques.size(); ++i) {
      // Monotonic from turn to turn, so that the stops go where the elongation says.
      judge.move_to(elongations[i]);
      EXPECT_NEAR(judge.torque(), torques[i], judge.error_bound(torques.size()) + 1e-12) << round << " " << i;
      EXPECT_LT(judge.error_bound(torques.size()), 1e-4);
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
