// The hysteretic spring against a brute-force sum of stop elements, which knows no reversal points and no
// closure rule.
#include "tests/support/stop_elements.hpp"

#include "core/friction/presliding/spring.hpp"
#include "tests/support/spring_moves.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

double uniform(std::mt19937_64& engine, double low, double high) {
  return low + (high - low) * std::ldexp(static_cast<double>(engine() >> 11), -53);
}

/// Largest difference of the spring's torque from that of the stop elements over a random sequence of
/// elongations, and its largest ratio to the error bound.
struct Difference {
  double absolute{0.0};
  double proportion{0.0};
};

Difference largest_difference(const friction::FrictionParameters& friction, std::size_t elements,
                              std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  friction::HystereticSpring spring(friction);
  StopElements stops(friction, elements);
  const double reach = uniform(engine, 0.3, 4.0) / friction.beta;
  Difference worst;
  for (int turn = 0; turn < 300; ++turn) {
    // Mostly short strokes inside, now and then one that wipes everything out.
    const double x = uniform(engine, 0.0, 1.0) < 0.1
                         ? uniform(engine, -2.0, 2.0) * reach
                         : spring.elongation() + uniform(engine, -0.5, 0.5) * reach;
    move_to(spring, x);
    stops.move_to(x);
    const double difference = std::abs(spring.torque() - stops.torque());
    worst.absolute = std::max(worst.absolute, difference);
    worst.proportion = std::max(worst.proportion, difference / (stops.error_bound(spring.depth()) + 1e-14));
  }
  return worst;
}

friction::FrictionParameters random_friction(std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  friction::FrictionParameters friction;
  friction.k1 = uniform(engine, 50.0, 150.0);
  friction.k2 = uniform(engine, 100.0, 1000.0);
  friction.beta = uniform(engine, 3e4, 5e5);
  return friction;
}

TEST(StopElements, SumEqualsTheSpringWithinTheBoundOfTheDiscretisation) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Difference difference = largest_difference(random_friction(seed), 400, seed + 1000);
    EXPECT_LT(difference.proportion, 1.0) << "seed " << seed;
  }
}

TEST(StopElements, SumConvergesToTheSpringQuadratically) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const friction::FrictionParameters friction = random_friction(seed);
    const double coarse = largest_difference(friction, 100, seed).absolute;
    const double fine = largest_difference(friction, 1600, seed).absolute;
    EXPECT_LT(fine, coarse / 64.0) << "seed " << seed;  // 256 for smooth convergence; the worst point moves
    EXPECT_LT(fine, 1e-6 * friction.k2 / friction.beta * 2.0) << "seed " << seed;
  }
}

/// The elongation at which the stop elements carry `torque`, reached monotonically from their present
/// elongation.
double elongation_at(const StopElements& stops, double from, double torque) {
  const double side = torque > stops.torque() ? 1.0 : -1.0;
  const auto reached = [&](double x) {
    StopElements moved = stops;
    moved.move_to(x);
    return side * (moved.torque() - torque) >= 0.0;
  };
  double step = 1e-6;
  while (!reached(from + side * step)) step *= 2.0;
  double low = 0.0;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + step);
    (reached(from + side * middle) ? step : low) = middle;
  }
  return from + side * step;
}

// Loaded by torque, the spring goes where the elements go: no branch law is inverted there.
TEST(StopElements, ReachTheTorquesOfAHistoryAtThePositionsOfTheSpring) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const friction::FrictionParameters friction = random_friction(seed);
    std::mt19937_64 engine(seed + 500);
    friction::HystereticSpring spring(friction);
    StopElements stops(friction, 1000);
    double x = 0.0;
    for (int level = 0; level < 40; ++level) {
      const double torque = friction.k2 / friction.beta * uniform(engine, -2.0, 2.0);
      spring.move_to_torque(torque);
      x = elongation_at(stops, x, torque);
      stops.move_to(x);
      EXPECT_NEAR(spring.elongation(), x, stops.error_bound(spring.depth()) / friction.k1) << level;
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
