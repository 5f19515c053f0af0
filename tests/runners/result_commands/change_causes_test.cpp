// The parameters that `monitor` tries as the cause of a change.
#include "runners/result_commands/change_causes.hpp"

#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::result_commands {
namespace {

using ::testing::Contains;
using ::testing::Field;

// Both masses have friction, and the coupling has a gap.
constexpr const char* axis_with_load = R"(zerocount: 1
name: axis
seed: 5
trials: 8
plant: {inertia: 1.0e-4, sliding_damping: 1.0e-3, load: {inertia: 1.5e-4, stiffness: 300, damping: 5.0e-3,
  gap: 3.0e-4, damping_to_ground: 1.0e-3, friction: {model: coulomb, breakaway: 2.0e-3, coulomb_ratio: 0.9}}}
friction: {model: coulomb, breakaway: {uniform: [1.0e-3, 2.0e-3]}, coulomb_ratio: 0.9}
encoder: {fine: 100000}
controller: {sample_rate: 4000, structure: cascade, cascade: {kv: 40, kp: 0.03, ki: 1.0}}
disturbance: {ripple: [{amplitude: 1.0e-4, periods: 7, phase: 1}]}
command: {targets: [900], hold: 0.1}
initial: {encoder_phase: {uniform: [0, 1]}}
)";

std::vector<std::string> names_of(const std::vector<Cause>& causes) {
  std::vector<std::string> names;
  for (const Cause& cause : causes) names.push_back(cause.name);
  return names;
}

std::vector<Cause> causes_of_axis(const std::vector<std::string>& overrides = {}) {
  return causes_of(manifest::parse_study(axis_with_load, "axis.yaml", overrides), 0);
}

TEST(ChangeCauses, CoverPlantLoadFrictionControlAndDisturbance) {
  const std::vector<std::string> names = names_of(causes_of_axis());
  for (const char* const name :
       {"plant.inertia", "plant.sliding_damping", "plant.load.inertia", "plant.load.stiffness",
        "plant.load.damping", "plant.load.gap", "plant.load.damping_to_ground",
        "plant.load.friction.breakaway", "friction.breakaway", "friction.coulomb_ratio",
        "controller.cascade.kv", "controller.cascade.kp", "controller.cascade.ki",
        "disturbance.ripple.0.amplitude"})
    EXPECT_THAT(names, Contains(name));
}

// An amount is added to what is 0 or absent, because no factor changes it.
TEST(ChangeCauses, AddAnAmountIfTheValueIsZero) {
  const auto of_kind = [](const std::string& name, monitor::ChangeKind kind) {
    return Contains(::testing::AllOf(Field(&Cause::name, name), Field(&Cause::kind, kind)));
  };
  using enum monitor::ChangeKind;
  const std::vector<Cause> without = causes_of_axis({"plant.load.gap=0"});
  for (const char* const name : {"encoder.fine_errors.noise", "controller.delay", "disturbance.torque",
                                 "disturbance.load.torque", "dac.offset", "plant.load.gap"})
    EXPECT_THAT(without, of_kind(name, amount));
  EXPECT_THAT(causes_of_axis(), of_kind("plant.load.gap", factor));
  EXPECT_THAT(causes_of_axis({"controller.delay=2"}), of_kind("controller.delay", factor));
}

TEST(ChangeCauses, ExcludePhasesCommandsAndStartValues) {
  for (const std::string& name : names_of(causes_of_axis())) {
    EXPECT_FALSE(name.ends_with("phase")) << name;
    EXPECT_FALSE(name.starts_with("command.") || name.starts_with("initial.") || name.starts_with("verdict."))
        << name;
  }
}

TEST(ChangeCauses, EachIncludesNoChange) {
  for (const Cause& cause : causes_of_axis()) {
    EXPECT_TRUE(std::ranges::is_sorted(cause.changes)) << cause.name;
    EXPECT_THAT(cause.changes, Contains(monitor::unchanged_by(cause.kind))) << cause.name;
  }
}

TEST(ChangeCauses, AFactorScalesTheValueOfEveryTrial) {
  const study::Study study = manifest::parse_study(axis_with_load, "axis.yaml");
  const auto scaled = study_with_factor(study, 0, {.name = "friction.breakaway"}, 1.67);
  ASSERT_TRUE(scaled);
  for (std::int64_t trial = 0; trial < 8; ++trial) {
    const double before = study::study_trial(study, 0, trial).parameters.friction.uniform.breakaway;
    const double after = study::study_trial(*scaled, 0, trial).parameters.friction.uniform.breakaway;
    EXPECT_NEAR(after, 1.67 * before, 1e-12);
  }
  EXPECT_FALSE(study_with_factor(study, 0, {.name = "friction.coulomb_ratio"}, 1.67))
      << "a ratio is at most 1";
}

TEST(ChangeCauses, AreFoundByAShortenedPath) {
  EXPECT_TRUE(is_named("controller.kp", "controller"));
  EXPECT_TRUE(is_named("encoder.fine_errors.noise", "encoder.noise"));
  EXPECT_TRUE(is_named("plant.load.gap", "plant.load.gap"));
  EXPECT_FALSE(is_named("plant.load.gap", "load.gap"));
  EXPECT_FALSE(is_named("plant.load.gap", "plant.gap.load"));
  EXPECT_FALSE(is_named("plant.load.gap", ""));
}

}  // namespace
}  // namespace zerocount::result_commands
