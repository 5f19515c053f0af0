#include "experiments/study/study_trial.hpp"

#include "core/trial/trial.hpp"
#include "experiments/designs/designs.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::study {
namespace {

const std::vector<std::string> designs{"monte_carlo", "latin_hypercube", "sobol"};

std::vector<double> column(const Study& study, const std::string& name, std::int64_t point = 0) {
  std::vector<double> values;
  for (std::int64_t i = 0; i < study.trials; ++i)
    values.push_back(study_trial(study, point, i).inputs[column_of(study, name)]);
  return values;
}

TEST(StudyTrial, DoesNotDependOnTheOrderOrTheThread) {
  for (const std::string& design : designs) {
    const Study study = study_of(full_manifest(), {"design=" + design});
    std::vector<std::vector<double>> forward;
    for (std::int64_t i = 0; i < 200; ++i) forward.push_back(study_trial(study, 2, i).inputs);
    std::vector<std::vector<double>> backward(200);
    const auto run = [&](std::int64_t first) {
      for (std::int64_t i = 199 - first; i >= 0; i -= 4)
        backward[static_cast<std::size_t>(i)] = study_trial(study, 2, i).inputs;
    };
    std::vector<std::thread> threads;
    for (std::int64_t t = 0; t < 4; ++t) threads.emplace_back(run, t);
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(forward, backward) << design;
  }
}

TEST(StudyTrial, AddingARandomParameterChangesNoOtherDraws) {
  for (const std::string& design : designs) {
    const std::string text = minimal_manifest("friction: {k2: {uniform: [1, 2]}}\n");
    const Study before = study_of(text, {"design=" + design, "command.targets=[{integers: [1, 1000]}]"});
    const Study after =
        study_of(text, {"design=" + design, "command.targets=[{integers: [1, 1000]}, {integers: [0, 9]}]",
                        "friction.k1={uniform: [1, 2]}", "verdict.dwell={uniform: [0.1, 0.2]}",
                        "sweep={grid: {controller.ki: [0, 1]}}"});
    EXPECT_EQ(column(before, "friction.k2"), column(after, "friction.k2")) << design;
    EXPECT_EQ(column(before, "command.targets.0"), column(after, "command.targets.0")) << design;
    EXPECT_NE(column(after, "friction.k2"), column(after, "friction.k1")) << design;
  }
}

TEST(StudyTrial, MoreTrialsKeepTheFirstOnesExceptInALatinHypercube) {
  for (const std::string design : {"monte_carlo", "sobol"}) {
    const Study few = study_of(full_manifest(), {"design=" + design, "trials=10"});
    const Study many = study_of(full_manifest(), {"design=" + design, "trials=1000000"});
    for (std::int64_t i = 0; i < 10; ++i)
      EXPECT_EQ(study_trial(few, 1, i).inputs, study_trial(many, 1, i).inputs);
  }
}

TEST(StudyTrial, AllPointsShareTheDrawsUnlessTheyAreIndependent) {
  for (const std::string& design : designs) {
    const Study shared = study_of(full_manifest(), {"design=" + design});
    EXPECT_EQ(column(shared, "friction.k2", 0), column(shared, "friction.k2", 5)) << design;
    const Study independent = study_of(full_manifest(), {"design=" + design, "independent_points=true"});
    EXPECT_NE(column(independent, "friction.k2", 0), column(independent, "friction.k2", 5)) << design;
    EXPECT_NE(column(independent, "friction.k2", 0), column(shared, "friction.k2", 0)) << design;
    // All points are on the same rotor, independent or not.
    EXPECT_EQ(independent.profiles[0].profile->cosine, shared.profiles[0].profile->cosine);
  }
}

TEST(StudyTrial, TheSeedChangesEverything) {
  for (const std::string& design : designs) {
    const Study one = study_of(full_manifest(), {"design=" + design, "seed=1"});
    const Study two = study_of(full_manifest(), {"design=" + design, "seed=2"});
    for (const char* name : {"friction.k1", "friction.k2", "command.targets.0", "initial.position"})
      EXPECT_NE(column(one, name), column(two, name)) << design << " " << name;
  }
}

// Every parameter of a stratified design has one trial in each stratum; of Monte Carlo trials, 1 − 1/e of the
// strata are hit.
TEST(StudyTrial, StratifiedDesignsFillEveryStratum) {
  const std::string text = minimal_manifest(
      "friction: {k1: {uniform: [1, 2]}, k2: {uniform: [1, 2]}}\n"
      "initial: {position: {uniform: [1, 2]}}\n");
  for (const std::string& design : designs) {
    const Study study = study_of(text, {"design=" + design, "trials=1024"});
    for (const char* name : {"friction.k1", "friction.k2", "initial.position"}) {
      std::set<int> strata;
      for (const double value : column(study, name)) strata.insert(static_cast<int>(1024 * (value - 1)));
      if (design == "monte_carlo") {
        EXPECT_NEAR(static_cast<double>(strata.size()), 1024 * (1 - std::exp(-1.0)), 5 * 11);
      } else {
        EXPECT_EQ(strata.size(), 1024u) << design << " " << name;
      }
    }
  }
}

// For n independent uniforms the mean is within 5/√(12n) of ½ but once in 1.7 million, and the correlation
// within 5/√n of 0.
TEST(StudyTrial, DrawsAreUniformAndIndependentBetweenParameters) {
  const Study study = study_of(minimal_manifest("friction: {k1: {uniform: [1, 2]}, k2: {uniform: [1, 2]}}\n"),
                               {"trials=40000"});
  const std::vector<double> k1 = column(study, "friction.k1");
  const std::vector<double> k2 = column(study, "friction.k2");
  const auto n = static_cast<double>(k1.size());
  double mean = 0.0;
  double product = 0.0;
  double with_next = 0.0;
  for (std::size_t i = 0; i < k1.size(); ++i) {
    mean += (k1[i] - 1.5) / n;
    product += 12 * (k1[i] - 1.5) * (k2[i] - 1.5) / n;
    with_next += 12 * (k1[i] - 1.5) * (k1[(i + 1) % k1.size()] - 1.5) / n;
  }
  EXPECT_LT(std::abs(mean), 5 / std::sqrt(12 * n));
  EXPECT_LT(std::abs(product), 5 / std::sqrt(n));
  EXPECT_LT(std::abs(with_next), 5 / std::sqrt(n));
}

// Where a trial's own random numbers come from: those that are drawn while it runs.

std::vector<random::RandomKey> keys_of(const random::TrialRandomness& r) {
  return {r.history, r.fine_noise, r.fine_missed, r.coarse_noise, r.coarse_missed, r.dac_noise};
}

TEST(TrialRandomness, IsKeyedBySeedAndName) {
  const random::TrialRandomness r =
      study_trial(study_of(minimal_manifest(), {"seed=77"}), 0, 3).parameters.randomness;
  EXPECT_EQ(r.history, designs::random_key(77, "initial.history/levels"));
  EXPECT_EQ(r.fine_noise, designs::random_key(77, "encoder.fine_errors.noise/samples"));
  EXPECT_EQ(r.fine_missed, designs::random_key(77, "encoder.fine_errors.missed/samples"));
  EXPECT_EQ(r.coarse_noise, designs::random_key(77, "encoder.coarse_errors.noise/samples"));
  EXPECT_EQ(r.coarse_missed, designs::random_key(77, "encoder.coarse_errors.missed/samples"));
  EXPECT_EQ(r.dac_noise, designs::random_key(77, "dac.noise/samples"));
}

TEST(TrialRandomness, SharesNoKeyWithDrawsOfTheStudy) {
  std::set<random::RandomKey> keys;
  std::size_t count = 0;
  for (const random::RandomKey& key :
       keys_of(study_trial(study_of(minimal_manifest()), 0, 0).parameters.randomness)) {
    keys.insert(key);
    ++count;
  }
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    EXPECT_EQ(parameter.name.find('/'), std::string_view::npos);
    keys.insert(designs::random_key(1, parameter.name));
    ++count;
  }
  EXPECT_EQ(keys.size(), count);
}

TEST(TrialRandomness, CountsTrialsAndPoints) {
  const std::string sweep = "sweep: {grid: {controller.kp: [0, 1, 2]}}\n";
  for (const bool independent : {false, true}) {
    const Study study = study_of(minimal_manifest(sweep),
                                 {independent ? "independent_points=true" : "independent_points=false"});
    for (std::int64_t point = 0; point < 3; ++point) {
      for (std::int64_t index = 0; index < study.trials; ++index) {
        const random::TrialRandomness r = study_trial(study, point, index).parameters.randomness;
        EXPECT_EQ(r.trial, static_cast<std::uint64_t>(index));
        EXPECT_EQ(r.stream, independent ? static_cast<std::uint32_t>(point) + 1 : 0u);
      }
    }
  }
}

TEST(TrialRandomness, DoesNotDependOnTheRestOfTheManifest) {
  const auto keys = [](const std::string& text, const std::vector<std::string>& overrides) {
    return keys_of(study_trial(study_of(text, overrides), 0, 0).parameters.randomness);
  };
  EXPECT_EQ(keys(minimal_manifest(), {"seed=3"}), keys(extended_manifest(), {"design=sobol"}));
  EXPECT_NE(keys(minimal_manifest(), {"seed=3"}), keys(minimal_manifest(), {"seed=4"}));
}

using F = StudyFeatures;

struct Example {
  bool F::*feature;
  bool expected;
  std::string manifest;  ///< text of the manifest from its sixth line on
  std::string command{"{targets: [5]}"};
};

// A study has a feature if some trial at some point can use it.
TEST(StudyFeatures, CoverEveryTrialAtEveryPoint) {
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
TEST(StudyFeatures, DoNotDependOnTheDraws) {
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
