#include "analysis/theory/theory_prediction.hpp"

#include "analysis/theory/trial_loops.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/plant/plant.hpp"
#include "core/theory/margins.hpp"
#include "core/theory/stability.hpp"
#include "core/trial/rig.hpp"
#include "tests/core/theory/frozen_loops.hpp"
#include "tests/support/test.hpp"

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

// The frozen loops of a trial: which there are, and that they have the parameters of trial, contact and
// phase.

std::vector<std::string> names_of(const std::vector<TrialLoop>& loops) {
  std::vector<std::string> names;
  for (const TrialLoop& loop : loops) names.push_back(loop.name);
  return names;
}

/// A trial in which nothing is at its default that a loop depends on.
trial::TrialParameters rich_trial() {
  trial::TrialParameters p;
  p.friction.uniform.k1 = 97.0;
  p.friction.uniform.k2 = 640.0;
  p.plant = {.inertia = 7e-4, .presliding_damping = 0.3, .sliding_damping = 4e-3, .load = {.inertia = 2e-4}};
  p.controller.kp = 3e-4;
  p.controller.ki = 2e-5;
  p.controller.kd = 1e-3;
  p.controller.delay = 1;
  p.dac.gain_error = 0.07;
  p.amplifier.bandwidth = 700.0;
  return p;
}

TEST(TrialLoops, AreThoseOfSpringAndSliding) {
  EXPECT_EQ(names_of(trial_loops(rich_trial())),
            (std::vector<std::string>{"at k1", "at k1 + k2", "while sliding"}));
  trial::TrialParameters two_phases = rich_trial();
  two_phases.controller.coarse.coarse_beyond = 1000.0;
  EXPECT_EQ(names_of(trial_loops(two_phases)),
            (std::vector<std::string>{"at k1", "at k1 + k2", "while sliding, the fine phase",
                                      "while sliding, the coarse phase"}));
}

TEST(TrialLoops, HaveTheMarginsOfTheirParameters) {
  trial::TrialParameters p = rich_trial();
  p.controller.coarse.coarse_beyond = 1000.0;
  p.controller.coarse.kp = 5e-4;
  p.controller.coarse.kd = 4e-3;
  const LinearDrive drive{1.07, 700.0};
  const loop::ControllerParameters fine = loop::controller_in_phase(p.controller, loop::ControlPhase::fine);
  const loop::ControllerParameters coarse =
      loop::controller_in_phase(p.controller, loop::ControlPhase::coarse);
  const StabilityMargins expected[] = {margins_about(97.0, 0.3, p.plant, p.encoder, fine, drive),
                                       margins_about(737.0, 0.3, p.plant, p.encoder, fine, drive),
                                       margins_about(0.0, 4e-3, p.plant, p.encoder, fine, drive),
                                       margins_about(0.0, 4e-3, p.plant, p.encoder, coarse, drive)};
  const std::vector<TrialLoop> loops = trial_loops(p);
  ASSERT_EQ(loops.size(), std::size(expected));
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const StabilityMargins margins = stability_margins(loops[i].loop);
    EXPECT_EQ(margins.gain.value, expected[i].gain.value) << loops[i].name;
    EXPECT_EQ(margins.gain.frequency, expected[i].gain.frequency) << loops[i].name;
    EXPECT_EQ(margins.phase.value, expected[i].phase.value) << loops[i].name;
    EXPECT_EQ(margins.phase.frequency, expected[i].phase.frequency) << loops[i].name;
    EXPECT_EQ(loops[i].slides, i >= 2);
  }
  EXPECT_EQ(stability_of(loops[0].loop, p.command.hold) == LoopStability::stable,
            sampled_spectral_radius(97.0, p.plant, p.encoder, fine, drive) < 1.0);
}

/// The stiffnesses of the law's loops, N m/rad.
std::vector<double> stiffnesses_of(friction::FrictionModel model) {
  trial::TrialParameters p = rich_trial();
  p.friction.model = model;
  p.friction.uniform.sigma0 = 900.0;
  p.friction.gms_elements = {{100.0, 0.4}, {300.0, 0.6}};
  std::vector<double> stiffnesses;
  for (const TrialLoop& loop : trial_loops(p)) {
    stiffnesses.push_back(loop.stiffness);
    EXPECT_EQ(loop.slides, loop.stiffness == 0.0);
  }
  return stiffnesses;
}

TEST(TrialLoops, AreThoseOfTheLaw) {
  using friction::FrictionModel;
  EXPECT_EQ(stiffnesses_of(FrictionModel::spring), (std::vector<double>{97.0, 737.0, 0.0}));
  EXPECT_EQ(stiffnesses_of(FrictionModel::dahl), (std::vector<double>{900.0, 0.0}));
  EXPECT_EQ(stiffnesses_of(FrictionModel::lugre), (std::vector<double>{900.0, 0.0}));
  EXPECT_EQ(stiffnesses_of(FrictionModel::gms), (std::vector<double>{400.0, 0.0}));
  EXPECT_EQ(stiffnesses_of(FrictionModel::coulomb), (std::vector<double>{0.0}));
  EXPECT_EQ(stiffnesses_of(FrictionModel::none), (std::vector<double>{0.0}));
}

/// A torque so small that no law yields moves the rotor as the first of the law's loops says: the plant of
/// the simulation against the held plant of the theory.
TEST(TrialLoops, BeginWithTheMotionOfTheLawUnderASmallTorque) {
  using friction::FrictionModel;
  for (const FrictionModel model : {FrictionModel::presliding, FrictionModel::spring, FrictionModel::dahl,
                                    FrictionModel::lugre, FrictionModel::gms, FrictionModel::none}) {
    trial::TrialParameters p;
    p.friction.model = model;
    p.friction.uniform.alpha = 1e-9;  // no creep
    p.friction.uniform.sigma1 = 0.05;
    const std::vector<TrialLoop> loops = trial_loops(p);
    // About its virgin state the spring has k1 + k2.
    const FrozenLoop& loop = loops[loops.front().name == "at k1" ? 1 : 0].loop;
    constexpr double torque = 1e-6;  // N m
    plant::Plant plant(p.plant, p.friction, trial::plant_start(p),
                       trial::motion_tolerance(loop::fine_resolution(p.encoder)));
    Eigen::VectorXd state = Eigen::VectorXd::Zero(loop.plant.A.rows());
    for (int k = 0; k < 40; ++k) {
      plant.advance(motion::constant_torque(torque), loop.sample_time);
      state = loop.plant.A * state + loop.plant.b * torque;
      const double counts = plant.read().theta / loop::fine_resolution(p.encoder);
      ASSERT_NEAR(counts, state(0), 1e-3 * std::abs(state(0))) << static_cast<int>(model) << " sample " << k;
    }
  }
}

TEST(TrialLoops, ThereAreNoneOfAPluginOrAnOpenLoop) {
  trial::TrialParameters plugin = rich_trial();
  trial::TrialParameters open = plugin;
  plugin.controller.user.plugin = std::make_shared<const plugin::ControllerPlugin>();
  open.command.torque.levels = {0.1};
  for (const trial::TrialParameters& p : {plugin, open}) {
    EXPECT_FALSE(why_outside_theory(p).empty());
    EXPECT_TRUE(trial_loops(p).empty());
  }
  EXPECT_TRUE(why_outside_theory(rich_trial()).empty());
}

}  // namespace
}  // namespace zerocount::theory
