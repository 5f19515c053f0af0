#include "experiments/manifest/load_study.hpp"

#include <unistd.h>

#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/marked_text.hpp"

namespace zerocount::manifest {
namespace {

using Names = std::vector<std::string>;

Names column_names(const study::Study& study) {
  Names names;
  for (const study::InputColumn& column : study.columns.inputs) names.push_back(column.name);
  return names;
}

TEST(Study, ReadsEverySection) {
  const study::Study study = study_of(full_manifest());
  EXPECT_EQ(study.name, "everything");
  EXPECT_EQ(study.description, "Every section once");
  EXPECT_EQ(study.seed, 20020721u);
  EXPECT_EQ(study.trials, 1000);
  EXPECT_EQ(study.design, study::Design::monte_carlo);
  EXPECT_FALSE(study.independent_points);
  EXPECT_EQ(study.moves, 2);
  EXPECT_EQ(study::point_count(study), 12);
  EXPECT_EQ(study::trial_count(study), 12000);
  EXPECT_EQ(study.retained_trials, (std::vector<std::int64_t>{0, 7}));
  EXPECT_EQ(study.observed.size(), 7u);
  EXPECT_EQ(study.manifest.text, full_manifest());
  EXPECT_TRUE(study.warnings.empty());
}

TEST(Study, MissingKeysTakeTheirDefaults) {
  const study::Study study = study_of(minimal_manifest());
  const trial::TrialParameters parameters = study::study_trial(study, 0, 0).parameters;
  const trial::TrialParameters defaults;
  EXPECT_EQ(parameters.plant.inertia, defaults.plant.inertia);
  EXPECT_EQ(parameters.friction.uniform.beta, defaults.friction.uniform.beta);
  EXPECT_EQ(parameters.verdict.window, defaults.verdict.window);
  EXPECT_EQ(parameters.command.targets, std::vector<std::int64_t>{5});
  EXPECT_TRUE(parameters.friction.profiled.empty());
  EXPECT_TRUE(study.columns.inputs.empty());
  EXPECT_TRUE(study::study_trial(study, 0, 0).inputs.empty());
}

TEST(Study, InputColumnsAreTheParametersThatDifferInTableOrder) {
  EXPECT_EQ(column_names(study_of(full_manifest())),
            (Names{"plant.inertia", "friction.k1", "friction.k2", "friction.beta", "friction.alpha",
                   "friction.breakaway", "controller.kp", "controller.ki", "controller.delay",
                   "controller.anti_windup", "command.targets.0", "initial.encoder_phase", "initial.position",
                   "initial.preload"}));
}

TEST(Study, InputsAreTheParametersOfTheTrial) {
  const study::Study study = study_of(full_manifest());
  for (std::int64_t i = 0; i < 20; ++i) {
    const study::StudyTrial trial = study::study_trial(study, 11, i);
    const auto input = [&](const std::string& name) { return trial.inputs[column_of(study, name)]; };
    EXPECT_EQ(input("friction.k2"), trial.parameters.friction.uniform.k2);
    EXPECT_EQ(input("controller.anti_windup"), 1.0);
    EXPECT_EQ(trial.parameters.controller.anti_windup, loop::AntiWindup::none);
    EXPECT_EQ(input("plant.inertia"), 6e-4);
    EXPECT_EQ(input("command.targets.0"), static_cast<double>(trial.parameters.command.targets[0]));
    EXPECT_EQ(input("controller.delay"), trial.parameters.controller.delay);
    EXPECT_EQ(trial.parameters.command.targets[1], 0);
    const friction::FrictionParameters contact =
        friction::friction_at(trial.parameters.friction, trial.parameters.initial.position);
    EXPECT_EQ(input("friction.k1"), contact.k1);
  }
}

TEST(Study, AllTrialsShareANamedProfile) {
  const study::Study study = study_of(full_manifest());
  ASSERT_EQ(study.profiles.size(), 1u);
  EXPECT_EQ(study.profiles[0].name, "friction.k1");
  EXPECT_EQ(study.profiles[0].unit, "N m/rad");
  for (const std::int64_t i : {0, 5}) {
    const friction::FrictionAlongRotor friction = study::study_trial(study, 3, i).parameters.friction;
    ASSERT_EQ(friction.profiled.size(), 1u);
    EXPECT_EQ(friction.profiled[0].profile, study.profiles[0].profile);
    EXPECT_EQ(friction.profiled[0].parameter, &friction::FrictionParameters::k1);
  }
}

TEST(Study, ProfilesThatDifferBetweenPointsAreNamedByTheFirst) {
  const std::string profile = "{profile: {mean: 110, cv: 0.1, correlation_length: ";
  const study::Study study =
      study_of(minimal_manifest("sweep: {grid: {friction.k1: [100, " + profile + "0.2}}, " + profile +
                                "0.5}}], controller.ki: [0, 1]}}\n"));
  ASSERT_EQ(study.profiles.size(), 2u);
  EXPECT_EQ(study.profiles[0].name, "friction.k1@2");
  EXPECT_EQ(study.profiles[1].name, "friction.k1@4");
  EXPECT_TRUE(study::study_trial(study, 0, 0).parameters.friction.profiled.empty());
  EXPECT_EQ(study::study_trial(study, 5, 0).parameters.friction.profiled[0].profile,
            study.profiles[1].profile);
}

TEST(Study, ReadsOptionalFeatures) {
  const study::Study study = study_of(extended_manifest());
  EXPECT_FALSE(study.open_loop);
  EXPECT_EQ(study.moves, 16);
  EXPECT_EQ(std::ssize(study.sequence), study.moves);
  EXPECT_TRUE(study.warnings.empty());
  EXPECT_EQ(column_names(study),
            (Names{"friction.model", "friction.breakaway", "encoder.fine_errors.eccentricity_angle",
                   "encoder.coarse_errors.missed", "dac.offset", "amplifier.bandwidth",
                   "controller.coarse.kd", "controller.coarse.fine_within", "command.sequence.targets.1",
                   "command.profile.shape", "command.profile.jerk_limit", "initial.history.reversals",
                   "initial.velocity", "initial.integral", "initial.mode"}));
}

TEST(Study, EnumeratedInputsAreStoredAsNumbers) {
  const study::Study study = study_of(extended_manifest());
  const std::size_t shape = column_of(study, "command.profile.shape");
  EXPECT_TRUE(
      study.columns.inputs[shape].meaning.ends_with(" (0 step, 1 trapezoidal, 2 s_curve, 3 sine, 4 record)"));
  EXPECT_EQ(study::study_trial(study, 0, 0).inputs[shape], 0);
  EXPECT_EQ(study::study_trial(study, 1, 0).inputs[shape], 2);
}

TEST(Study, SeedsOfAll64BitsAreKept) {
  EXPECT_EQ(study_of(minimal_manifest(), {"seed=18446744073709551615"}).seed, 18446744073709551615u);
}

TEST(Study, TrialsThatDoNotExistAreRefused) {
  const study::Study study = study_of(minimal_manifest());
  EXPECT_THROW(study::study_trial(study, 1, 0), Failure);
  EXPECT_THROW(study::study_trial(study, -1, 0), Failure);
  EXPECT_THROW(study::study_trial(study, 0, 10), Failure);
  EXPECT_THROW(study::study_trial(study, 0, -1), Failure);
}

class ManifestFile : public ::testing::Test {
 protected:
  ManifestFile() { std::filesystem::create_directories(folder); }
  ~ManifestFile() override { std::filesystem::remove_all(folder); }

  std::string failure_of(const std::filesystem::path& path, ExitCode code) {
    return refusal_by([&] { load_study(path); }, code);
  }

  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("zerocount_study_test_" + std::to_string(::getpid()));
};

TEST_F(ManifestFile, IsReadAndNamedInMessages) {
  const auto path = folder / "good.yaml";
  std::ofstream(path) << minimal_manifest();
  EXPECT_EQ(load_study(path).manifest.text, minimal_manifest());
  const auto bad = folder / "bad.yaml";
  const MarkedText marked = marked_text(minimal_manifest("plant: «1»\n"));
  std::ofstream(bad) << marked.text;
  const std::string message = with_marks(failure_of(bad, ExitCode::bad_input), bad.string(), marked);
  EXPECT_TRUE(message.starts_with(bad.string() + ":«»: plant: ")) << message;
}

TEST_F(ManifestFile, AMissingFileOrADirectoryIsBadInput) {
  EXPECT_TRUE(says(failure_of(folder / "none.yaml", ExitCode::bad_input), "no such file"));
  EXPECT_TRUE(says(failure_of(folder, ExitCode::bad_input), "this is a directory"));
}

TEST_F(ManifestFile, TwoMegabytesAreTooLarge) {
  const auto path = folder / "huge.yaml";
  std::ofstream(path) << std::string(2'000'000, 'x');
  EXPECT_EQ(failure_of(path, ExitCode::bad_input),
            path.string() + ":1:1: manifest: the file is too large; expected at most 1048576 bytes");
}

TEST_F(ManifestFile, ADeviceIsRefused) {
  EXPECT_TRUE(says(failure_of("/dev/zero", ExitCode::bad_input), "not a regular file"));
}

}  // namespace
}  // namespace zerocount::manifest
