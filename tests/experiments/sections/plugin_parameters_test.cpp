// The parameters of a user's controller in manifests, without its library: a description is enough.
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/plan.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sections {
namespace {

constexpr double without_limit = std::numeric_limits<double>::infinity();

PluginLoader two_parameters() {
  return known_plugin(std::make_shared<const plugin::ControllerPlugin>(
      plugin::ControllerPlugin{{"own",
                                "1",
                                "0123",
                                {{"gain", "N m/count", "a gain", 3.0, 0.0, 10.0},
                                 {"offset", "1", "any", 0.0, -without_limit, without_limit}}}}));
}

study::Study study_with_plugin(const std::string& more, const std::vector<std::string>& overrides = {}) {
  return manifest::parse_study(minimal_manifest(more), "m.yaml", overrides, {.plugin = two_parameters()});
}

std::string refusal_with_plugin(const std::string& more, const PluginLoader& load = two_parameters()) {
  try {
    manifest::parse_study(minimal_manifest(more), "m.yaml", {}, {.plugin = load});
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    return failure.what();
  }
  return "";
}

const std::string own = "controller: {plugin: own.so, parameters: {gain: {uniform: [1, 5]}}}\n";

TEST(PluginParameters, HaveTheirDefaultsAndDistributions) {
  const study::Study study = study_with_plugin(own);
  const study::StudyTrial trial = study::study_trial(study, 0, 3);
  ASSERT_EQ(study.columns.inputs.size(), 1u);
  EXPECT_EQ(study.columns.inputs[0].name, "controller.parameters.gain");
  EXPECT_EQ(study.columns.inputs[0].unit, "N m/count");
  EXPECT_EQ(study.columns.inputs[0].meaning, "a gain");
  ASSERT_EQ(trial.parameters.controller.user.parameters.size(), 2u);
  EXPECT_EQ(trial.parameters.controller.user.parameters[0], trial.inputs[0]);
  EXPECT_EQ(trial.parameters.controller.user.parameters[1], 0.0);
  const study::Study without = study_with_plugin("controller: {plugin: own.so}\n");
  EXPECT_EQ(study::study_trial(without, 0, 0).parameters.controller.user.parameters,
            (std::vector<double>{3, 0}));
}

TEST(PluginParameters, AreSweptAndOverridden) {
  const study::Study study =
      study_with_plugin(own +
                            "sweep: {cases: {a: {controller.parameters.offset: -2}, b: {}}, grid: "
                            "{controller.parameters.gain: {linspace: [2, "
                            "4, 3]}}}\n",
                        {"controller.parameters.offset=7"});
  ASSERT_EQ(study::point_count(study), 6);
  EXPECT_EQ(study::study_trial(study, 1, 0).parameters.controller.user.parameters,
            (std::vector<double>{3, -2}));
  EXPECT_EQ(study::study_trial(study, 5, 0).parameters.controller.user.parameters,
            (std::vector<double>{4, 7}));
}

TEST(PluginParameters, AreDrawnForRigsAndInEveryDesign) {
  EXPECT_EQ(study_with_plugin(own, {"rigs=5", "trials=10"}).columns.rigs.size(), 1u);
  EXPECT_EQ(study_with_plugin(own, {"design=saltelli", "trials=9"}).factors,
            std::vector<std::string>{"controller.parameters.gain"});
  const study::Study sobol = study_with_plugin(own, {"design=sobol", "trials=8"});
  std::vector<double> gains;
  for (std::int64_t i = 0; i < 8; ++i) gains.push_back(study::study_trial(sobol, 0, i).inputs[0]);
  std::sort(gains.begin(), gains.end());
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(static_cast<std::size_t>((gains[i] - 1) / 4 * 8), i);
}

TEST(PluginParameters, AnotherLibraryMakesAnotherStudy) {
  const auto sha_of = [](const char* sha256) {
    return manifest::parse_study(minimal_manifest("controller: {plugin: own.so}\n"), "m.yaml", {},
                                 {.plugin = known_plugin(std::make_shared<const plugin::ControllerPlugin>(
                                      plugin::ControllerPlugin{{"own", "1", sha256, {}}}))})
        .study_sha256;
  };
  EXPECT_EQ(sha_of("01"), sha_of("01"));
  EXPECT_NE(sha_of("01"), sha_of("02"));
}

TEST(PluginParameters, ErrorsNameThePlace) {
  const std::vector<std::pair<std::string, std::string>> refusals{
      {"controller: {plugin: own.so, parameters: {gian: 1}}", "6:43: controller.parameters.gian | gain"},
      {"controller: {plugin: own.so, parameters: {gain: 11}}",
       "6:49: controller.parameters.gain | at least 0 and at most 10"},
      {"controller: {plugin: own.so, parameters: 3}", "6:42: controller.parameters | '3'"},
      {"controller: {parameters: {gain: 1}}", "6:26: controller.parameters | controller.plugin"},
      {"controller: {plugin: own.so, kp: 1.0e-4}", "6:34: controller.kp | no effect | controller.parameters"},
      {"controller: {plugin: own.so, coarse: {coarse_beyond: 200}}",
       "6:54: controller.coarse.coarse_beyond | has no phases"},
      {"controller: {plugin: [own.so]}", "6:22: controller.plugin | a list"},
      {"controller: {plugin: own.so}\nsweep: {grid: {controller.parameters.gian: [1]}}",
       "7:16: sweep.grid.controller.parameters.gian | controller.parameters.gain"},
  };
  for (const auto& [text, message] : refusals) EXPECT_TRUE(has_faults(refusal_with_plugin(text), message));
  EXPECT_TRUE(has_faults(refusal_with_plugin("controller: {plugin: own.so}", {}),
                         "6:22: controller.plugin | this command does not"));
}

TEST(PluginParameters, APluginClosesTheLoop) {
  try {
    manifest::parse_study(manifest_commanding("{torque: {levels: [0.1]}}", "controller: {plugin: own.so}\n"),
                          "m.yaml", {}, {.plugin = two_parameters()});
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_TRUE(
        has_faults(std::string(failure.what()), "6:22: controller.plugin | no effect | command.targets"));
  }
}

}  // namespace
}  // namespace zerocount::sections
