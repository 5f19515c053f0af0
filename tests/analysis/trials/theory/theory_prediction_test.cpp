#include "analysis/trials/theory/theory_prediction.hpp"

#include "analysis/trials/theory/trial_loops.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/plant/plant.hpp"
#include "core/theory/margins.hpp"
#include "core/theory/stability.hpp"
#include "core/trial/machine.hpp"
#include "core/trial/trial.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/core/theory/frozen_loops.hpp"
#include "tests/support/test.hpp"

namespace zerocount::theory {
namespace {

trial::TrialParameters paper_machine(double ki) {
  trial::TrialParameters
      parameters;  // the defaults are the paper's machine: bounds 3.85e-5 and 3.01e-4 N m/count
  parameters.controller.ki = ki;
  return parameters;
}

TEST(TheoryPrediction, MatchesTheGainsOfThePaper) {
  const TrialPrediction below = predict(paper_machine(3.85e-5));
  EXPECT_TRUE(below.stable);
  EXPECT_FALSE(below.unstable);
  const TrialPrediction between = predict(paper_machine(2.08e-4));
  EXPECT_FALSE(between.stable);
  EXPECT_FALSE(between.unstable);
  const TrialPrediction above = predict(paper_machine(3.1e-4));
  EXPECT_FALSE(above.stable);
  EXPECT_TRUE(above.unstable);
}

TEST(TheoryPrediction, ProportionalGainMakesAnIntegralGainStable) {
  trial::TrialParameters parameters = paper_machine(9.4e-5);
  EXPECT_FALSE(predict(parameters).stable);
  parameters.controller.kp = 6.21e-4;
  EXPECT_TRUE(predict(parameters).stable);
}

TEST(TheoryPrediction, WithoutAnIntegralOrAtABoundNothingIsPredicted) {
  EXPECT_FALSE(predict(paper_machine(0.0)).stable);
  EXPECT_FALSE(predict(paper_machine(0.0)).unstable);
  EXPECT_TRUE(predict(paper_machine(-1e-6)).unstable);
  const IntegralGainBounds bounds = predict(paper_machine(1e-5)).bounds;
  EXPECT_FALSE(predict(paper_machine(bounds.stable_below)).stable);
  EXPECT_FALSE(predict(paper_machine(bounds.unstable_above)).unstable);
}

TEST(TheoryPrediction, UsesTheStiffnessWhereTheTrialStarts) {
  // k1 = 110 + 50·cos θ: 160 at 0, 60 at π. The bound of (6) is in proportion to k1.
  trial::TrialParameters parameters = paper_machine(3.85e-5);
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

TEST(TheoryPrediction, DoesNotApplyToOpenLoopsAndFrictionWithoutASpring) {
  trial::TrialParameters coulomb = paper_machine(3e-5), air = coulomb, open_loop = coulomb, spring = coulomb;
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

TEST(TheoryPrediction, VerdictIsUndecidedWithProportionsIfTrialsDiffer) {
  PointPrediction stable, unstable, mixed, rare;
  for (int i = 0; i < 10; ++i) {
    stable.add(predict(paper_machine(3e-5)));
    unstable.add(predict(paper_machine(4e-4)));
    mixed.add(predict(paper_machine(i < 3 ? 3e-5 : i < 5 ? 4e-4 : 1e-4)));
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

/// The parameters of a trial in which everything that a loop depends on differs from its default.
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

TEST(TrialLoops, CoverTheSpringAndTheSlidingAxis) {
  EXPECT_EQ(names_of(trial_loops(rich_trial())),
            (std::vector<std::string>{"at k1", "at k1 + k2", "while sliding"}));
  trial::TrialParameters two_phases = rich_trial();
  two_phases.controller.coarse.coarse_beyond = 1000.0;
  EXPECT_EQ(names_of(trial_loops(two_phases)),
            (std::vector<std::string>{"at k1", "at k1 + k2", "while sliding, the fine phase",
                                      "while sliding, the coarse phase"}));
}

// The page, check and tune take the ends of a profile from one place.
TEST(TrialLoops, IncludeTheEndsOfAProfile) {
  const friction::Profile profile{friction::Marginal::normal, 100.0, 20.0, {0.0, 1.0}, {0.0, 0.0}};
  trial::TrialParameters p = rich_trial();
  p.friction.profiled = {
      {&friction::FrictionParameters::k1, std::make_shared<const friction::Profile>(profile)}};
  const std::vector<TrialLoop> loops = trial_loops(p);
  EXPECT_EQ(names_of(loops), (std::vector<std::string>{"at k1", "at k1 + k2", std::string(at_softest),
                                                       std::string(at_stiffest), "while sliding"}));
  EXPECT_NEAR(loops[0].stiffness, 120.0, 1e-9);
  EXPECT_NEAR(loops[2].stiffness, 80.0, 1e-9);
  EXPECT_NEAR(loops[3].stiffness, 760.0, 1e-9);
  p.friction.model = friction::FrictionModel::lugre;
  EXPECT_EQ(names_of(trial_loops(p)), (std::vector<std::string>{"at sigma0", "while sliding"}));
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
    // NaN where there is no margin.
    const auto expect_equal = [&](const Margin& margin, const Margin& other) {
      EXPECT_THAT(margin.value, ::testing::NanSensitiveDoubleEq(other.value)) << loops[i].name;
      EXPECT_THAT(margin.frequency, ::testing::NanSensitiveDoubleEq(other.frequency)) << loops[i].name;
    };
    expect_equal(margins.gain, expected[i].gain);
    expect_equal(margins.phase, expected[i].phase);
    EXPECT_EQ(loops[i].slides, i >= 2);
  }
  EXPECT_EQ(stability_of(loops[0].loop, p.command.hold) == LoopStability::stable,
            sampled_spectral_radius(97.0, p.plant, p.encoder, fine, drive) < 1.0);
}

/// The contact stiffnesses (N m/rad) with which the theory linearises the loop under this friction law.
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

TEST(TrialLoops, HaveTheStiffnessesOfTheFrictionLaw) {
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

std::vector<std::string> names_with(friction::LoadFrictionModel model, double gap,
                                    motion::EncoderPlace encoder = motion::EncoderPlace::motor,
                                    bool velocity_by_other = false) {
  trial::TrialParameters p = rich_trial();
  p.friction.model = friction::FrictionModel::none;
  p.load_side.friction.model = model;
  p.plant.load.gap = gap;
  p.plant.load.encoder = encoder;
  p.controller.velocity_by_other = velocity_by_other;
  if (velocity_by_other) p.controller.blocks.structure = loop::ControlStructure::cascade;
  p.encoder.other = {1e5, 2.0 * std::numbers::pi};
  EXPECT_EQ(states_without_loop(p).size() + trial_loops(p).size(), load_states(p).size());
  return names_of(trial_loops(p));
}

TEST(TrialLoops, CoverEachStateOfTheLoad) {
  using friction::LoadFrictionModel;
  using motion::EncoderPlace;
  using Names = std::vector<std::string>;
  const Names slides{"without friction, the load slides"};
  const std::string stands = "without friction, the load stands";
  const std::string held = "without friction, the load held by its friction";
  const std::string alone = "without friction, the motor alone in the gap";
  EXPECT_EQ(names_with(LoadFrictionModel::none, 0.0), Names{"without friction"});
  EXPECT_EQ(names_with(LoadFrictionModel::none, 1e-3), (Names{"without friction", alone}));
  EXPECT_EQ(names_with(LoadFrictionModel::coulomb, 0.0), (Names{slides[0], stands}));
  EXPECT_EQ(names_with(LoadFrictionModel::coulomb, 1e-3), (Names{slides[0], stands, alone}));
  EXPECT_EQ(names_with(LoadFrictionModel::dahl, 0.0), (Names{slides[0], held}));
  EXPECT_EQ(names_with(LoadFrictionModel::lugre, 1e-3), (Names{slides[0], held, alone}));
  // An encoder of the load does not see the motor alone: the loop is cut, unless its velocity loop does.
  EXPECT_EQ(names_with(LoadFrictionModel::coulomb, 1e-3, EncoderPlace::load), slides);
  EXPECT_EQ(names_with(LoadFrictionModel::coulomb, 1e-3, EncoderPlace::load, true),
            (Names{slides[0], stands, alone}));
}

/// Ratio of the largest motor velocity in the last tenth of a simulated trial to the largest in its first
/// tenth.
double velocity_left(const trial::TrialParameters& p) {
  double first = 0.0;
  double last = 0.0;
  const auto samples = static_cast<double>(trial::samples_of_trial(p));
  const auto watch = [&](const trial::SampleRecord& record) {
    const auto k = static_cast<double>(record.k);
    if (k < 0.1 * samples) first = std::max(first, std::abs(record.omega));
    if (k > 0.9 * samples) last = std::max(last, std::abs(record.omega));
  };
  trial::run_trial(p, {watch, {}, {}});
  return last / first;
}

/// A state of the load (such as at one end of a gap) in which a machine stays.
struct StateOfMachine {
  friction::LoadFrictionModel model;
  double gap;
  std::string name;
};

// A machine that stays in a state of its load moves as the loop of that state: its motion dies out where the
// loop is stable, and grows up to the torque range where it is not. So it does with each encoder in each loop
// of the cascade.
TEST(TrialLoops, PredictWhetherTheMotionDecaysInEachStateOfTheLoad) {
  using friction::LoadFrictionModel;
  const StateOfMachine states[] = {{LoadFrictionModel::none, 100.0, ", the motor alone in the gap"},
                                   {LoadFrictionModel::coulomb, 0.0, ", the load stands"},
                                   {LoadFrictionModel::dahl, 0.0, ", the load held by its friction"},
                                   {LoadFrictionModel::lugre, 0.0, ", the load held by its friction"}};
  testing::RandomBlocks draw(97);
  int dies = 0;
  int grows = 0;
  for (int i = 0; i < 160; ++i) {
    const StateOfMachine& state = states[static_cast<std::size_t>(i % 4)];
    trial::TrialParameters p;
    p.friction.model = friction::FrictionModel::none;
    p.plant = {.inertia = draw.log_uniform(5e-5, 5e-4),
               .presliding_damping = draw.log_uniform(1e-4, 5e-3),
               .load = {.inertia = draw.log_uniform(1e-4, 1e-3),
                        .stiffness = draw.log_uniform(20.0, 400.0),
                        .damping = draw.log_uniform(1e-3, 3e-2),
                        .gap = state.gap}};
    // The load stands all the time.
    if (state.gap > 0.0) p.plant.load.damping_to_ground = 1.0;
    p.load_side.friction = {
        state.model,
        {.breakaway = 1e6, .coulomb_ratio = 1.0, .sigma0 = draw.log_uniform(20.0, 400.0), .sigma1 = 0.01}};
    p.encoder.fine = 2e8;
    p.encoder.other = {2e8, 2.0 * std::numbers::pi};
    p.dac = {.bits = 24, .resolution = 1e-6};
    p.controller = {.sample_rate = 4000.0, .delay = 1.0};
    p.controller.blocks.structure = loop::ControlStructure::cascade;
    p.controller.blocks.cascade = {.kv = draw.log_uniform(10.0, 200.0),
                                   .kp = draw.log_uniform(3e-3, 1.5),
                                   .ki = draw.log_uniform(0.05, 10.0)};
    p.controller.velocity_by_other = draw.chance(0.5);
    p.plant.load.encoder = draw.chance(0.5) ? motion::EncoderPlace::load : motion::EncoderPlace::motor;
    p.command = {.targets = {0}, .hold = 0.5};
    p.initial.velocity = 0.01;
    const std::vector<TrialLoop> loops = trial_loops(p);
    const auto found =
        std::ranges::find_if(loops, [&](const TrialLoop& loop) { return loop.name.ends_with(state.name); });
    if (found == loops.end()) continue;  // cut
    const double growth = log_growth(found->loop, p.command.hold);
    if (std::abs(growth) < 4.0) continue;  // too slow to be seen
    ++(growth < 0.0 ? dies : grows);
    const double left = velocity_left(p);
    EXPECT_EQ(left < 0.3, growth < 0.0)
        << i << ": " << found->name << ", growth " << growth << ", left " << left;
  }
  EXPECT_GT(dies, 15);
  EXPECT_GT(grows, 15);
}

TEST(TrialLoops, AreEmptyForAPluginOrAnOpenLoop) {
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
