#include "experiments/study/study.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::study {
namespace {

using F = StudyFeatures;

struct Example {
  bool F::*feature;
  bool expected;
  std::string manifest;  ///< from the sixth line on
  std::string command{"{targets: [5]}"};
};

// A study has a feature if some trial at some point can use it.
TEST(StudyFeatures, AreThoseOfAnyTrialAtAnyPoint) {
  const std::string drawn = "friction: {k1: {uniform: [100, 120]}}\n";
  const std::string torque = "{torque: {levels: [0.1]}}";
  std::vector<Example> examples{
      {&F::travel, true, "", "{targets: [5], profile: {shape: s_curve}}"},
      {&F::travel, true, "sweep: {grid: {command.profile.shape: [step, trapezoidal]}}"},
      {&F::phases, false, "controller: {coarse: {coarse_beyond: 1.0e12}}"},
      {&F::phases, true, "controller: {coarse: {coarse_beyond: 1000}}"},
      {&F::phases, true, "controller: {coarse: {coarse_beyond: {uniform: [1000, 1.0e12]}}}"},
      {&F::phases, true, "sweep: {cases: {one: {}, two: {controller.coarse.coarse_beyond: 200}}}"},
      {&F::stopping, true, "verdict: {stop: true}"},
      {&F::stopping, false, "verdict: {stop: false}"},
      {&F::stopping, true, "sweep: {grid: {verdict.stop: [false, true]}}"},
      {&F::drive_torque, false, "controller: {delay: 2}"},
      {&F::drive_torque, true, "controller: {delay: 2}", torque},
      {&F::drive_torque, false, "", torque},
      {&F::drive_torque, true, "", "{torque: {levels: [0.1], through: exact}}"},
      {&F::drive_torque, false, "dac: {noise: 0, offset: 0}\namplifier: {bandwidth: 0}"},
      {&F::drive_torque, true, "amplifier: {bandwidth: 100}"},
      {&F::drive_torque, true, "dac: {offset: {uniform: [-1, 0]}}"},
      {&F::final_error, true, "controller: {ki: 0}"},
      {&F::final_error, true, "friction: {model: coulomb}"},
      {&F::final_error, false, "friction: {model: spring}"},
      {&F::final_error, false, "friction: {model: none}"},
      {&F::final_error, true, "sweep: {grid: {controller.ki: [3.85e-5, 0]}}"},
      {&F::final_error, true, "sweep: {grid: {friction.model: [presliding, spring, coulomb]}}"},
      {&F::final_error, true, "controller: {coarse: {coarse_beyond: 1000}}"},
      {&F::final_error, true, "sweep: {grid: {command.profile.shape: [trapezoidal]}}"},
      {&F::encoder_errors, true, "sweep: {cases: {a: {}, b: {encoder.coarse_errors.noise: 0.1}}}"},
      {&F::dependent_trials, true, drawn + "design: saltelli", "{targets: [5]}"},
      {&F::dependent_trials, false, drawn + "design: sobol"}};
  for (bool F::*const feature : {&F::open_loop, &F::travel, &F::phases, &F::encoder_errors, &F::final_error,
                                 &F::drive_torque, &F::stopping, &F::dependent_trials})
    examples.push_back({feature, false, ""});
  for (const std::string encoder : {"fine_errors", "coarse_errors"}) {
    for (const std::string error : {"eccentricity", "interpolation", "noise", "missed"}) {
      for (const bool on : {false, true})
        examples.push_back({&F::encoder_errors, on,
                            fmt::format("encoder: {{{}: {{{}: {}}}}}", encoder, error, on ? "1.0e-3" : "0")});
    }
  }
  for (const std::string error : {"offset", "gain_error", "nonlinearity", "noise"}) {
    examples.push_back({&F::drive_torque, true, "dac: {" + error + ": 1.0e-6}"});
    examples.push_back({&F::drive_torque, true, "sweep: {grid: {dac." + error + ": [0, 1.0e-6]}}"});
  }
  for (const Example& example : examples) {
    EXPECT_EQ(study_of(manifest_commanding(example.command, example.manifest), {"trials=9"}).features.*
                  example.feature,
              example.expected)
        << example.command << " " << example.manifest;
  }
}

// One seed draws an error in the first trial, another does not: the columns are the same.
TEST(StudyFeatures, DoNotDependOnWhatIsDrawn) {
  for (int seed = 1; seed <= 20; ++seed) {
    const auto features = [seed](const std::string& more) {
      return study_of(minimal_manifest(more), {fmt::format("seed={}", seed)}).features;
    };
    EXPECT_TRUE(features("encoder: {fine_errors: {noise: {choice: [0, 0.3]}}}").encoder_errors) << seed;
    EXPECT_FALSE(features("encoder: {fine_errors: {noise: {choice: [0, 0]}}}").encoder_errors) << seed;
    EXPECT_TRUE(features("controller: {ki: {choice: [3.85e-5, 0]}}").final_error) << seed;
    EXPECT_FALSE(features("controller: {ki: {choice: [3.85e-5, 9.45e-5]}}").final_error) << seed;
  }
}

}  // namespace
}  // namespace zerocount::study
