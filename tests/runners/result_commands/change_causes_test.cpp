// The parameters that may have changed in a machine, from the table of parameters.
#include "runners/result_commands/change_causes.hpp"

#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

using result_commands::Cause;
using Names = std::vector<std::string>;

/// An axis with a load behind a gap, under a cascade, with a vibration.
constexpr const char* axis = R"(zerocount: 1
name: axis
trials: 4
plant:
  inertia: {lognormal: {median: 1.0e-4, cv: 0.1}}
  sliding_damping: 1.0e-3
  load: {inertia: 1.5e-4, stiffness: 300, damping: 5.0e-3, gap: 3.0e-4, damping_to_ground: 1.0e-3, encoder: motor,
         friction: {model: coulomb, breakaway: 2.0e-3, coulomb_ratio: 0.9}}
friction: {model: coulomb, breakaway: 2.0e-3, coulomb_ratio: 0.9}
encoder: {fine: 100000, fine_errors: {interpolation: 0.1}}
dac: {bits: 16, range: 2}
controller: {sample_rate: 4000, delay: 1, structure: cascade, cascade: {kv: 40, kp: 0.03, ki: 1.0}}
disturbance: {vibration: [{amplitude: 1.0e-4, frequency: 30}]}
command: {targets: [1000, 0], hold: 0.1}
)";

class ChangeCauses : public ::testing::Test {
 protected:
  study::Study loaded(const std::string& text) const {
    return manifest::load_study(folder_.write("study.yaml", text), {}, {.plugin = {}, .samples = {}});
  }

  TemporaryFolder folder_;
};

bool has(const std::vector<Cause>& causes, std::string_view name, bool is_amount = false) {
  const auto found = std::ranges::find(causes, name, &Cause::name);
  return found != causes.end() && static_cast<bool>(found->add) == is_amount;
}

TEST_F(ChangeCauses, AreTheNumbersOfPlantLoadFrictionControlDriveAndDisturbances) {
  const std::vector<Cause> causes = result_commands::causes_of(loaded(axis), 0);
  for (const char* const name :
       {"plant.inertia", "plant.sliding_damping", "plant.load.inertia", "plant.load.stiffness",
        "plant.load.damping", "plant.load.gap", "plant.load.damping_to_ground",
        "plant.load.friction.breakaway", "plant.load.friction.coulomb_ratio", "friction.breakaway",
        "friction.coulomb_ratio", "encoder.fine_errors.interpolation", "dac.range", "controller.delay",
        "controller.cascade.kv", "controller.cascade.kp", "controller.cascade.ki",
        "disturbance.vibration.0.amplitude", "disturbance.vibration.0.frequency"})
    EXPECT_TRUE(has(causes, name)) << name << " is multiplied";
  for (const char* const name : {"encoder.fine_errors.noise", "dac.gain_error", "controller.deadband.enter",
                                 "disturbance.torque", "disturbance.load.torque"})
    EXPECT_TRUE(has(causes, name, true)) << name << " is 0, and is added to";
  for (const Cause& cause : causes)
    for (const char* const other : {"command.", "initial.", "verdict."})
      EXPECT_FALSE(cause.name.starts_with(other)) << cause.name << " does not change in use";
  EXPECT_FALSE(has(causes, "encoder.fine"));
  EXPECT_FALSE(has(causes, "disturbance.vibration.0.phase"));
  EXPECT_FALSE(has(causes, "friction.k1")) << "it has no effect in this study";
}

TEST_F(ChangeCauses, AddAGapWhereALoadHasNone) {
  std::string text = axis;
  text.replace(text.find("gap: 3.0e-4, "), 13, "");
  const std::vector<Cause> causes = result_commands::causes_of(loaded(text), 0);
  ASSERT_TRUE(has(causes, "plant.load.gap", true));
  trial::TrialParameters trial = study::study_trial(loaded(text), 0, 0).parameters;
  std::ranges::find(causes, "plant.load.gap", &Cause::name)->add(trial, 1.0e-3);
  EXPECT_EQ(trial.plant.load.gap, 1.0e-3);
}

// With each change the trial is another one, and only by what the cause names.
TEST_F(ChangeCauses, MultiplyTheValueOfTheStudy) {
  const study::Study study = loaded(axis);
  for (const Cause& cause : result_commands::causes_of(study, 0)) {
    EXPECT_TRUE(std::ranges::is_sorted(cause.changes)) << cause.name;
    EXPECT_EQ(std::ranges::count(cause.changes, monitor::unchanged_by(cause.kind)), 1) << cause.name;
  }
  const Cause inertia{.name = "plant.inertia", .changes = {1.0}};
  const std::optional<study::Study> heavier = result_commands::study_with_factor(study, 0, inertia, 1.5);
  ASSERT_TRUE(heavier);
  for (int trial = 0; trial < 4; ++trial) {
    const trial::TrialParameters before = study::study_trial(study, 0, trial).parameters;
    const trial::TrialParameters after = study::study_trial(*heavier, 0, trial).parameters;
    EXPECT_DOUBLE_EQ(after.plant.inertia, 1.5 * before.plant.inertia);
    EXPECT_EQ(after.plant.load.inertia, before.plant.load.inertia);
  }
  const Cause ratio{.name = "friction.coulomb_ratio", .changes = {1.0}};
  EXPECT_FALSE(result_commands::study_with_factor(study, 0, ratio, 1.2)) << "it would be 1.08";
}

TEST_F(ChangeCauses, TakeNamesOfWhatCannotHaveChanged) {
  const study::Study study = loaded(axis);
  EXPECT_EQ(result_commands::unchanged_names(study, {"plant.load,encoder.noise", "disturbance.vibration"}),
            (Names{"plant.load", "encoder.noise", "disturbance.vibration"}));
  EXPECT_TRUE(result_commands::is_named("encoder.fine_errors.noise", "encoder.noise"));
  EXPECT_FALSE(result_commands::is_named("encoder.fine_errors.noise", "noise"));
  EXPECT_TRUE(says(refusal_by([&] { result_commands::unchanged_names(study, {"command.hold"}); }),
                   "'command.hold' is not among the parameters that are tried"));
}

}  // namespace
}  // namespace zerocount::testing
