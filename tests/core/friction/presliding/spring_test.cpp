// The hysteretic spring: branch law, virgin curve, wiping-out, congruency, energy.
#include "core/friction/presliding/spring.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/lambert_w.hpp>

#include "tests/support/branch_law.hpp"
#include "tests/support/each_seed.hpp"
#include "tests/support/spring_moves.hpp"
#include "tests/support/test.hpp"

namespace zerocount::friction {
namespace {

FrictionParameters random_friction(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  FrictionParameters friction;
  friction.k1 = 20.0 + 300.0 * unit(random);
  friction.k2 = 100.0 + 2000.0 * unit(random);
  friction.beta = std::pow(10.0, 4.0 + 2.0 * unit(random));
  return friction;
}

/// Random elongations (rad) for a spring: a random walk over a few softening lengths 1/β.
std::vector<double> random_targets(std::mt19937& random, double beta, int count) {
  std::normal_distribution<double> normal(0.0, 3.0 / beta);
  std::vector<double> targets(static_cast<std::size_t>(count));
  for (double& target : targets) target = normal(random);
  return targets;
}

/// Parameters of a random friction contact, whose spring is tested.
struct SpringProperties {
  static constexpr unsigned seeds = 40;
  explicit SpringProperties(unsigned seed) : random_(seed) {}

  std::mt19937 random_;
  FrictionParameters friction_{random_friction(random_)};
  double length_{1.0 / friction_.beta};
  double torque_scale_{friction_.k2 / friction_.beta};
};

TEST_EACH_SEED(SpringProperties, TangentFallsFromTheHighestToTheLowestStiffness) {
  HystereticSpring spring(friction_);
  testing::move_to(spring, 5.0 * length_);
  spring.set_direction(-1);
  EXPECT_NEAR(stiffness_on(spring.branch(), spring.elongation()), friction_.k1 + friction_.k2,
              1e-9 * friction_.k2);
  EXPECT_NEAR(stiffness_on(spring.branch(), spring.elongation() - 60.0 * length_), friction_.k1,
              1e-9 * friction_.k2);
}

TEST_EACH_SEED(SpringProperties, VirginCurveIsHalfTheBranchLawOfTwiceTheElongation) {
  for (const double x : random_targets(random_, friction_.beta, 20)) {
    HystereticSpring spring(friction_);
    testing::move_to(spring, x);
    EXPECT_EQ(spring.depth(), 0u);
    EXPECT_NEAR(spring.torque(), std::copysign(0.5 * testing::branch_law(friction_, 2.0 * std::abs(x)), x),
                1e-14 * torque_scale_);
  }
}

TEST_EACH_SEED(SpringProperties, ClosedMinorLoopDissipatesTheClosedForm) {
  HystereticSpring spring(friction_);
  testing::move_to(spring, random_targets(random_, friction_.beta, 1)[0] + 10.0 * length_);
  const double top = spring.elongation();
  const double span = length_ * std::uniform_real_distribution<double>(0.05, 6.0)(random_);
  const auto work_to = [&](double x) {  // ∫σ dx from here to x along the branch
    spring.set_direction(x > spring.elongation() ? 1 : -1);
    const SpringBranch branch = spring.branch();
    const auto torque = [&](double at) { return torque_on(branch, at); };
    const double from = spring.elongation();
    const double low = std::min(from, x);
    const double work =
        boost::math::quadrature::gauss_kronrod<double, 61>::integrate(torque, low, std::max(from, x));
    testing::move_to(spring, x);
    return x > from ? work : -work;
  };
  const double dissipated = work_to(top - span) + work_to(top);
  const double y = friction_.beta * span;
  const double closed_form = friction_.k2 / (friction_.beta * friction_.beta) *
                             (y * (1.0 + std::exp(-y)) - 2.0 * (1.0 - std::exp(-y)));
  EXPECT_NEAR(dissipated, closed_form, 1e-10 * closed_form + 1e-14 * torque_scale_ * length_);
}

TEST_EACH_SEED(SpringProperties, DepthStaysAlternatingAndNested) {
  HystereticSpring spring(friction_);
  for (int n = 40; n > 0; --n) testing::move_to(spring, (n % 2 == 0 ? 1.0 : -1.0) * n * 0.3 * length_);
  EXPECT_EQ(spring.depth(), 39u);  // a shrinking zigzag forgets nothing
  testing::move_to(spring, 13.0 * length_);
  EXPECT_EQ(spring.depth(), 0u);  // one excursion beyond all of it forgets everything
}

TEST_EACH_SEED(SpringProperties, InverseOfTheBranchLawIsLambertsW) {
  for (int i = 0; i < 20; ++i) {
    const double torque = 10.0 * torque_scale_ * std::uniform_real_distribution<double>(0.0, 1.0)(random_);
    const double softening = friction_.k2 / friction_.beta;
    const double ratio = friction_.k2 / friction_.k1;
    const double shift = (torque - softening) / friction_.k1;
    const double closed_form =
        shift + boost::math::lambert_w0(ratio * std::exp(-friction_.beta * shift)) / friction_.beta;
    EXPECT_NEAR(inverse_branch_law(friction_, torque), closed_form, 1e-12 * (closed_form + length_));
    EXPECT_NEAR(testing::branch_law(friction_, inverse_branch_law(friction_, torque)), torque,
                1e-13 * torque_scale_);
    HystereticSpring spring(friction_);
    testing::move_to(spring, virgin_elongation(friction_, -torque));
    EXPECT_NEAR(spring.torque(), -torque, 1e-13 * torque_scale_);
  }
}

TEST_EACH_SEED(SpringProperties, PreloadLeavesOneReversalPointAndNoTorque) {
  for (const double preload : {2.0 * torque_scale_, -3.0 * torque_scale_}) {
    HystereticSpring spring(friction_);
    spring.start_preloaded(preload);
    EXPECT_EQ(spring.depth(), 1u);
    EXPECT_NEAR(spring.torque(), 0.0, 1e-13 * torque_scale_);
    EXPECT_GT(spring.elongation() * preload, 0.0);  // it does not spring back all the way

    HystereticSpring loaded(friction_);
    testing::move_to(loaded, virgin_elongation(friction_, preload));
    testing::move_to(loaded, spring.elongation());
    EXPECT_NEAR(loaded.torque(), spring.torque(), 1e-13 * torque_scale_);
  }
}

/// Random torques (N m) for a spring: a random walk up to three times k2/β.
std::vector<double> random_torques(std::mt19937& random, double scale, int count) {
  std::uniform_real_distribution<double> uniform(-3.0 * scale, 3.0 * scale);
  std::vector<double> torques(static_cast<std::size_t>(count));
  for (double& torque : torques) torque = uniform(random);
  return torques;
}

TEST_EACH_SEED(SpringProperties, ReachesTheRequestedTorque) {
  HystereticSpring spring(friction_);
  for (const double torque : random_torques(random_, torque_scale_, 300)) {
    spring.move_to_torque(torque);
    // To the rounding of the elongation.
    const double rounding = 4e-16 * (friction_.k1 + friction_.k2) * std::abs(spring.elongation());
    EXPECT_NEAR(spring.torque(), torque, rounding + 4e-15 * torque_scale_);
  }
}

// Also where a virgin curve is run inwards and then outwards again.
TEST_EACH_SEED(SpringProperties, PointAtATorqueEqualsTheEndOfAMoveToIt) {
  std::normal_distribution<double> normal(0.0, torque_scale_);
  for (int history = 0; history < 50; ++history) {
    HystereticSpring spring(friction_);
    const double start = normal(random_) / friction_.k2;
    if (history % 2 == 0) spring.start_virgin(start, start > 0.0 ? -1 : 1);
    for (const double part : {0.8, 0.5}) {
      if (history % 2 == 0) testing::move_to(spring, part * start);
    }
    for (const double x : random_targets(random_, friction_.beta, history % 6)) testing::move_to(spring, x);
    for (int i = 0; i < 4; ++i) {
      const double torque = normal(random_);
      HystereticSpring moved = spring;
      moved.move_to_torque(torque);
      EXPECT_NEAR(spring.point_at_torque(torque).elongation, moved.elongation(), 1e-9 * length_)
          << history << " to " << torque;
    }
  }
}

// The spring that follows from what one measures of it: its virgin curve passes through what was measured.

class MeasuredSpring : public ::testing::Test {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0, 1)); }
  /// A random number in (0, 1), as often near 0 or near 1 as in between.
  double fraction() {
    const double distance = log_uniform(1e-9, 0.5);
    return uniform(0, 1) < 0.5 ? distance : 1.0 - distance;
  }

 private:
  std::mt19937_64 random_{11};
};

/// Spring torque σv(x) on the virgin curve at the travel x, N m.
double virgin_torque(double final, const Softening& softening, double travel) {
  FrictionParameters contact;
  contact.k1 = final;
  contact.k2 = softening.k2;
  contact.beta = softening.beta;
  return 0.5 * testing::branch_law(contact, 2.0 * travel);
}

TEST_F(MeasuredSpring, PassesThroughThePointAndHasBothStiffnesses) {
  for (int i = 0; i < 20000; ++i) {
    const double final = log_uniform(1, 1e8);
    const double initial = final * log_uniform(1.001, 1e4);
    const double travel = log_uniform(1e-9, 1e-2);
    const VirginPoint point{travel, travel * (final + fraction() * (initial - final))};
    const auto found = softening_from(initial, final, point);
    ASSERT_TRUE(found) << i;
    EXPECT_NEAR((final + found->k2) / initial, 1.0, 1e-15);
    EXPECT_NEAR(virgin_torque(final, *found, travel) / point.torque, 1.0, 1e-12) << i;
  }
}

TEST_F(MeasuredSpring, PassesThroughBothPoints) {
  for (int i = 0; i < 20000; ++i) {
    const double final = log_uniform(1, 1e8);
    const double secant = final * log_uniform(1.001, 1e4);
    const double travel = log_uniform(1e-9, 1e-2);
    const VirginPoint first{travel, travel * secant};
    const double last = travel * log_uniform(1.001, 1e4);
    const double low = first.torque + final * (last - travel);
    const double high = secant * last;
    const VirginPoint point{last, low + fraction() * (high - low)};
    const auto found = softening_through(first, point, final);
    ASSERT_TRUE(found) << i;
    EXPECT_NEAR(virgin_torque(final, *found, first.travel) / first.torque, 1.0, 1e-12) << i;
    EXPECT_NEAR(virgin_torque(final, *found, last) / point.torque, 1.0, 1e-12) << i;
  }
}

// Both ways say the same spring.
TEST_F(MeasuredSpring, IsRecoveredFromASecantOfItsCurve) {
  for (int i = 0; i < 1000; ++i) {
    const double final = log_uniform(1e2, 1e6);
    const Softening spring{final * log_uniform(0.1, 100), log_uniform(1e4, 1e7)};
    const double travel = log_uniform(0.3, 3) / spring.beta;
    const double first = travel * uniform(0.1, 0.9);
    const VirginPoint last{travel, virgin_torque(final, spring, travel)};
    const auto by_initial = softening_from(final + spring.k2, final, last);
    const auto by_secant = softening_through({first, virgin_torque(final, spring, first)}, last, final);
    ASSERT_TRUE(by_initial && by_secant);
    EXPECT_NEAR(by_initial->beta / spring.beta, 1.0, 1e-9);
    EXPECT_NEAR(by_secant->beta / spring.beta, 1.0, 1e-8);
    EXPECT_NEAR(by_secant->k2 / spring.k2, 1.0, 1e-8);
  }
}

TEST_F(MeasuredSpring, DoesNotExistOutsideItsConditions) {
  for (int i = 0; i < 1000; ++i) {
    const double excess = log_uniform(1.0 + 1e-9, 3);
    EXPECT_FALSE(softening_from(100, 10, {1e-3, 1e-3 * 10 / excess}));
    EXPECT_FALSE(softening_from(100, 10, {1e-3, 1e-3 * 100 * excess}));
    EXPECT_FALSE(softening_through({1e-4, 1e-4 * 10 / excess}, {1e-3, 0.02}, 10));
    EXPECT_FALSE(softening_through({1e-3 * excess, 0.1 * excess}, {1e-3, 0.05}, 10));
    EXPECT_FALSE(softening_through({1e-4, 0.01}, {1e-3, 0.1 * excess}, 10));
    EXPECT_FALSE(softening_through({1e-4, 0.01}, {1e-3, (0.01 + 10 * 9e-4) / excess}, 10));
  }
}

// A contact that is loaded from virgin carries breakaway at the end of its pre-sliding range, and not before.
TEST(PreslidingRange, IsTheTravelAtWhichAVirginContactCarriesBreakaway) {
  std::mt19937_64 random(3);
  const auto log_uniform = [&random](double low, double high) {
    return low * std::pow(high / low, std::uniform_real_distribution<double>(0, 1)(random));
  };
  for (int i = 0; i < 2000; ++i) {
    FrictionParameters contact;
    contact.k1 = log_uniform(1, 1e6);
    contact.k2 = log_uniform(1, 1e8);
    contact.beta = log_uniform(1e2, 1e7);
    contact.breakaway = log_uniform(1e-3, 1e3);
    const double range = presliding_range(contact);
    EXPECT_NEAR(0.5 * testing::branch_law(contact, 2.0 * range) / contact.breakaway, 1.0, 1e-13);
    HystereticSpring spring(contact);
    spring.start_virgin(0.0, 1);
    testing::move_to(spring, range * (1.0 - 1e-9));
    EXPECT_LT(spring.torque(), contact.breakaway);
    EXPECT_LE(range, contact.breakaway / contact.k1);
    EXPECT_GE(range, contact.breakaway / (contact.k1 + contact.k2));
  }
}

TEST(PreslidingRange, HasClosedFormsIfATermOfTheSpringIsMissing) {
  FrictionParameters contact;
  contact.k2 = 0.0;
  EXPECT_DOUBLE_EQ(presliding_range(contact), contact.breakaway / contact.k1);

  contact = {};
  contact.k1 = 0.0;
  contact.breakaway = 0.6 * contact.k2 / (2.0 * contact.beta);
  EXPECT_NEAR(presliding_range(contact), -std::log(1.0 - 0.6) / (2.0 * contact.beta), 1e-15);
  contact.breakaway = contact.k2 / (2.0 * contact.beta);
  EXPECT_EQ(presliding_range(contact), std::numeric_limits<double>::infinity());
  contact.k2 = 0.0;
  EXPECT_EQ(presliding_range(contact), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace zerocount::friction
