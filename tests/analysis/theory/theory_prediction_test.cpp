#include "analysis/theory/theory_prediction.hpp"

#include <memory>

#include <gtest/gtest.h>

namespace zerocount::theory {
namespace {

trial::TrialParameters paper_rig(double ki) {
  trial::TrialParameters
      parameters;  // the defaults are the paper's rig: bounds 3.85e-5 and 3.01e-4 N m/count
  parameters.controller.ki = ki;
  return parameters;
}

TEST(TheoryPrediction, GainsOfThePaper) {
  const TrialPrediction below = predict(paper_rig(3.85e-5));
  EXPECT_TRUE(below.stable);
  EXPECT_FALSE(below.unstable);
  const TrialPrediction between = predict(paper_rig(2.08e-4));
  EXPECT_FALSE(between.stable);
  EXPECT_FALSE(between.unstable);
  const TrialPrediction above = predict(paper_rig(3.1e-4));
  EXPECT_FALSE(above.stable);
  EXPECT_TRUE(above.unstable);
}

TEST(TheoryPrediction, ProportionalGainMakesAnIntegralGainStable) {
  trial::TrialParameters parameters = paper_rig(9.4e-5);
  EXPECT_FALSE(predict(parameters).stable);
  parameters.controller.kp = 6.21e-4;
  EXPECT_TRUE(predict(parameters).stable);
}

TEST(TheoryPrediction, WithoutIntegralOrOnABoundNothingIsPromised) {
  EXPECT_FALSE(predict(paper_rig(0.0)).stable);
  EXPECT_FALSE(predict(paper_rig(0.0)).unstable);
  EXPECT_TRUE(predict(paper_rig(-1e-6)).unstable);
  const IntegralGainBounds bounds = predict(paper_rig(1e-5)).bounds;
  EXPECT_FALSE(predict(paper_rig(bounds.stable_below)).stable);
  EXPECT_FALSE(predict(paper_rig(bounds.unstable_above)).unstable);
}

TEST(TheoryPrediction, ATrialIsGovernedByTheStiffnessWhereItStarts) {
  // k1 = 110 + 50·cos θ: 160 at 0, 60 at π. The bound of (6) is in proportion to k1.
  trial::TrialParameters parameters = paper_rig(3.85e-5);
  const friction::Profile profile{friction::Marginal::normal, 110.0, 50.0, {0.0, 1.0}, {0.0, 0.0}};
  parameters.friction.profiled.push_back(
      {&friction::FrictionParameters::k1, std::make_shared<friction::Profile>(profile)});
  const TrialPrediction stiff = predict(parameters);
  parameters.initial.position = 3.14159265358979;
  const TrialPrediction soft = predict(parameters);
  EXPECT_TRUE(stiff.stable);
  EXPECT_FALSE(soft.stable);
  EXPECT_NEAR(soft.bounds.stable_below / stiff.bounds.stable_below, 60.0 / 160.0, 1e-12);
}

TEST(TheoryPrediction, TheCriteriaAreNotAboutOpenLoopsAndFrictionWithoutASpring) {
  trial::TrialParameters coulomb = paper_rig(3e-5), air = coulomb, open_loop = coulomb, spring = coulomb;
  coulomb.friction.model = friction::FrictionModel::coulomb;
  air.friction.model = friction::FrictionModel::none;
  open_loop.command.torque.levels = {0.1};
  spring.friction.model = friction::FrictionModel::spring;
  EXPECT_TRUE(predict(spring).applies);
  EXPECT_TRUE(predict(spring).stable);
  PointPrediction point;
  for (const trial::TrialParameters& parameters : {coulomb, air, open_loop}) {
    const TrialPrediction prediction = predict(parameters);
    EXPECT_FALSE(prediction.applies || prediction.stable || prediction.unstable);
    point.add(prediction);
  }
  EXPECT_EQ(predicted_trials(point), 0);
  EXPECT_EQ(verdict(point), "not applicable");
  point.add(predict(spring));
  EXPECT_EQ(predicted_trials(point), 4) << "a proportion is of all trials";
}

TEST(TheoryPrediction, VerdictIsThatOfAllTrialsOrUndecidedWithItsShares) {
  PointPrediction stable, unstable, mixed, rare;
  for (int i = 0; i < 10; ++i) {
    stable.add(predict(paper_rig(3e-5)));
    unstable.add(predict(paper_rig(4e-4)));
    mixed.add(predict(paper_rig(i < 3 ? 3e-5 : i < 5 ? 4e-4 : 1e-4)));
  }
  rare = {100000, 99999, 0};
  EXPECT_EQ(verdict(stable), "stable");
  EXPECT_EQ(verdict(unstable), "unstable");
  EXPECT_EQ(verdict(mixed), "undecided: (6) holds in 30.0 %, (7) exceeded in 20.0 %");
  EXPECT_EQ(verdict(rare), "undecided: (6) holds in > 99.9 %, (7) exceeded in 0 %");
  EXPECT_EQ(verdict({}), "unknown");
}

}  // namespace
}  // namespace zerocount::theory
