// The hysteretic spring: branch law, virgin curve, wiping-out, congruency, energy.
#include "core/friction/presliding/spring.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/lambert_w.hpp>
#include <gtest/gtest.h>

#include "tests/support/each_seed.hpp"

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

/// Elongations of a random walk over a few softening lengths.
std::vector<double> random_targets(std::mt19937& random, double beta, int count) {
  std::normal_distribution<double> normal(0.0, 3.0 / beta);
  std::vector<double> targets(static_cast<std::size_t>(count));
  for (double& target : targets) target = normal(random);
  return targets;
}

/// A random contact.
struct SpringProperties {
  static constexpr unsigned seeds = 40;
  explicit SpringProperties(unsigned seed) : random_(seed) {}

  std::mt19937 random_;
  FrictionParameters friction_{random_friction(random_)};
  double length_{1.0 / friction_.beta};
  double torque_scale_{friction_.k2 / friction_.beta};
};

TEST_EACH_SEED(SpringProperties, TangentRunsFromTheHighestToTheLowestStiffness) {
  HystereticSpring spring(friction_);
  spring.move_to(5.0 * length_);
  spring.set_direction(-1);
  EXPECT_NEAR(stiffness_on(spring.branch(), spring.elongation()), friction_.k1 + friction_.k2,
              1e-9 * friction_.k2);
  EXPECT_NEAR(stiffness_on(spring.branch(), spring.elongation() - 60.0 * length_), friction_.k1,
              1e-9 * friction_.k2);
}

TEST_EACH_SEED(SpringProperties, VirginCurveIsHalfTheBranchLawOfTwiceTheElongation) {
  for (const double x : random_targets(random_, friction_.beta, 20)) {
    HystereticSpring spring(friction_);
    spring.move_to(x);
    EXPECT_EQ(spring.depth(), 0u);
    EXPECT_NEAR(spring.torque(), std::copysign(0.5 * branch_law(friction_, 2.0 * std::abs(x)), x),
                1e-14 * torque_scale_);
  }
}

TEST_EACH_SEED(SpringProperties, ReachingTheMirrorImageOfTheOnlyReversalPointRestoresTheVirginCurve) {
  HystereticSpring spring(friction_);
  const double peak = 4.0 * length_;
  spring.move_to(peak);
  const double torque = spring.torque();
  spring.move_to(-0.999 * peak);
  EXPECT_EQ(spring.depth(), 1u);
  spring.move_to(-peak);
  EXPECT_EQ(spring.depth(), 0u);
  EXPECT_NEAR(spring.torque(), -torque, 1e-13 * torque_scale_);
}

TEST_EACH_SEED(SpringProperties, ClosedMinorLoopDissipatesTheClosedForm) {
  HystereticSpring spring(friction_);
  spring.move_to(random_targets(random_, friction_.beta, 1)[0] + 10.0 * length_);
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
    spring.move_to(x);
    return x > from ? work : -work;
  };
  const double dissipated = work_to(top - span) + work_to(top);
  const double y = friction_.beta * span;
  const double closed_form = friction_.k2 / (friction_.beta * friction_.beta) *
                             (y * (1.0 + std::exp(-y)) - 2.0 * (1.0 - std::exp(-y)));
  EXPECT_NEAR(dissipated, closed_form, 1e-10 * closed_form + 1e-14 * torque_scale_ * length_);
}

TEST_EACH_SEED(SpringProperties, ClosedExcursionIsForgotten) {
  HystereticSpring spring(friction_);
  for (const double x : random_targets(random_, friction_.beta, 30)) spring.move_to(x);
  const int direction = spring.direction();
  spring.move_to(spring.elongation() +
                 direction * 5.0 * length_);  // so that the excursion below closes no older loop
  const HystereticSpring before = spring;
  // Back, wander inside, and return: the loop closes and everything inside is wiped out.
  const double span = length_ * std::uniform_real_distribution<double>(0.1, 2.0)(random_);
  const double turn = spring.elongation();
  std::uniform_real_distribution<double> inside(0.0, span);
  spring.move_to(turn - direction * span);
  for (int i = 0; i < 12; ++i) spring.move_to(turn - direction * inside(random_));
  spring.move_to(turn);
  EXPECT_NEAR(spring.torque(), before.torque(), 1e-12 * torque_scale_);

  HystereticSpring straight = before;
  for (const double x : random_targets(random_, friction_.beta, 30)) {
    spring.move_to(x + direction * 8.0 * length_);
    straight.move_to(x + direction * 8.0 * length_);
    EXPECT_NEAR(spring.torque(), straight.torque(), 1e-12 * torque_scale_);
    EXPECT_EQ(spring.depth(), straight.depth());
  }
}

TEST_EACH_SEED(SpringProperties, MinorLoopsOfEqualSpanAreCongruentWhereverTheyLie) {
  const double span = length_ * std::uniform_real_distribution<double>(0.1, 4.0)(random_);
  std::vector<double> heights;
  for (int history = 0; history < 10; ++history) {
    HystereticSpring spring(friction_);
    for (const double x : random_targets(random_, friction_.beta, 1 + history)) spring.move_to(x);
    spring.move_to(spring.elongation() + 20.0 * length_);  // so that the loop below does not close another
    const double top = spring.torque();
    spring.move_to(spring.elongation() - span);
    heights.push_back(top - spring.torque());
  }
  for (const double height : heights) EXPECT_NEAR(height, branch_law(friction_, span), 1e-12 * torque_scale_);
}

TEST_EACH_SEED(SpringProperties, OppositeMotionGivesOppositeTorque) {
  HystereticSpring spring(friction_);
  HystereticSpring mirror(friction_);
  for (const double x : random_targets(random_, friction_.beta, 200)) {
    spring.move_to(x);
    mirror.move_to(-x);
    EXPECT_EQ(spring.torque(), -mirror.torque());
    EXPECT_EQ(spring.depth(), mirror.depth());
  }
}

TEST_EACH_SEED(SpringProperties, ManySmallStepsEqualOneLargeOne) {
  HystereticSpring coarse(friction_);
  HystereticSpring fine(friction_);
  for (const double x : random_targets(random_, friction_.beta, 60)) {
    const double from = fine.elongation();
    for (int i = 1; i < 50; ++i) fine.move_to(from + (x - from) * i / 50.0);
    fine.move_to(x);
    coarse.move_to(x);
    EXPECT_NEAR(fine.torque(), coarse.torque(), 1e-12 * torque_scale_);
    EXPECT_EQ(fine.depth(), coarse.depth());
  }
}

TEST_EACH_SEED(SpringProperties, TorqueIsContinuousThroughClosures) {
  HystereticSpring spring(friction_);
  const double step = 1e-7 * length_;
  for (const double x : random_targets(random_, friction_.beta, 60)) {
    spring.move_to(x);
    for (std::optional<double> end = spring.branch_end(); end; end = spring.branch_end()) {
      spring.move_to(*end - spring.direction() * step);
      const double before = spring.torque();
      spring.move_to(*end + spring.direction() * step);
      EXPECT_NEAR(spring.torque(), before, 2.1 * step * (friction_.k1 + friction_.k2));
    }
  }
}

TEST_EACH_SEED(SpringProperties, DepthStaysAlternatingAndNested) {
  HystereticSpring spring(friction_);
  for (int n = 40; n > 0; --n) spring.move_to((n % 2 == 0 ? 1.0 : -1.0) * n * 0.3 * length_);
  EXPECT_EQ(spring.depth(), 39u);  // a shrinking zigzag forgets nothing
  spring.move_to(13.0 * length_);
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
    EXPECT_NEAR(branch_law(friction_, inverse_branch_law(friction_, torque)), torque, 1e-13 * torque_scale_);
    HystereticSpring spring(friction_);
    spring.move_to(virgin_elongation(friction_, -torque));
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
    loaded.move_to(virgin_elongation(friction_, preload));
    loaded.move_to(spring.elongation());
    EXPECT_NEAR(loaded.torque(), spring.torque(), 1e-13 * torque_scale_);
  }
}

/// Torques of a random walk up to three times k2/β.
std::vector<double> random_torques(std::mt19937& random, double scale, int count) {
  std::uniform_real_distribution<double> uniform(-3.0 * scale, 3.0 * scale);
  std::vector<double> torques(static_cast<std::size_t>(count));
  for (double& torque : torques) torque = uniform(random);
  return torques;
}

TEST_EACH_SEED(SpringProperties, ReachesTheTorqueItIsTakenTo) {
  HystereticSpring spring(friction_);
  for (const double torque : random_torques(random_, torque_scale_, 300)) {
    spring.move_to_torque(torque);
    // To the rounding of the elongation.
    const double rounding = 4e-16 * (friction_.k1 + friction_.k2) * std::abs(spring.elongation());
    EXPECT_NEAR(spring.torque(), torque, rounding + 4e-15 * torque_scale_);
  }
}

TEST_EACH_SEED(SpringProperties, TakenToATorqueIsTheSpringTakenToItsElongation) {
  HystereticSpring by_torque(friction_);
  HystereticSpring by_elongation(friction_);
  for (const double torque : random_torques(random_, torque_scale_, 300)) {
    by_torque.move_to_torque(torque);
    by_elongation.move_to(by_torque.elongation());
    EXPECT_EQ(by_torque.depth(), by_elongation.depth());
    EXPECT_EQ(by_torque.direction(), by_elongation.direction());
    EXPECT_NEAR(by_torque.torque(), by_elongation.torque(), 1e-14 * torque_scale_);
  }
}

TEST_EACH_SEED(SpringProperties, TorqueOfAReversalPointClosesItsLoop) {
  HystereticSpring spring(friction_);
  const double s = torque_scale_;
  for (const double torque : {2.0 * s, -1.0 * s, 1.0 * s, 0.5 * s}) spring.move_to_torque(torque);
  EXPECT_EQ(spring.depth(), 3u);
  spring.move_to_torque(1.0 * s);
  EXPECT_EQ(spring.depth(), 2u);  // back on the branch from −1
  spring.move_to_torque(2.0 * s);
  EXPECT_EQ(spring.depth(), 0u);
  spring.move_to_torque(-2.0 * s);
  EXPECT_EQ(spring.depth(), 0u);  // the mirror image of the only reversal point
  EXPECT_NEAR(spring.elongation(), virgin_elongation(friction_, -2.0 * s), 1e-14 * length_);
}

TEST_EACH_SEED(SpringProperties, TorqueTakesAStretchedVirginSpringThroughItsOrigin) {
  HystereticSpring spring(friction_);
  spring.start_virgin(virgin_elongation(friction_, torque_scale_), -1);  // as after a slide backwards
  spring.move_to_torque(0.4 * torque_scale_);
  EXPECT_NEAR(spring.elongation(), virgin_elongation(friction_, 0.4 * torque_scale_), 1e-14 * length_);
  spring.move_to_torque(-0.7 * torque_scale_);
  EXPECT_NEAR(spring.elongation(), virgin_elongation(friction_, -0.7 * torque_scale_), 1e-14 * length_);
  EXPECT_EQ(spring.depth(), 0u);
}

// Also where a virgin curve is run inwards and then outwards again.
TEST_EACH_SEED(SpringProperties, PointAtATorqueIsWhereTheMoveToItEnds) {
  std::normal_distribution<double> normal(0.0, torque_scale_);
  for (int history = 0; history < 50; ++history) {
    HystereticSpring spring(friction_);
    const double start = normal(random_) / friction_.k2;
    if (history % 2 == 0) spring.start_virgin(start, start > 0.0 ? -1 : 1);
    for (const double part : {0.8, 0.5}) {
      if (history % 2 == 0) spring.move_to(part * start);
    }
    for (const double x : random_targets(random_, friction_.beta, history % 6)) spring.move_to(x);
    for (int i = 0; i < 4; ++i) {
      const double torque = normal(random_);
      HystereticSpring moved = spring;
      moved.move_to_torque(torque);
      EXPECT_NEAR(spring.point_at_torque(torque).elongation, moved.elongation(), 1e-9 * length_)
          << history << " to " << torque;
    }
  }
}

}  // namespace
}  // namespace zerocount::friction
