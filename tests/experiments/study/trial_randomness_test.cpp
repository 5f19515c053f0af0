// Where a trial's own random numbers come from: those that are drawn while it runs.

#include <set>

#include <gtest/gtest.h>

#include "experiments/designs/random_key.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::study {
namespace {

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

TEST(TrialRandomness, SharesNoKeyWithAnyDrawOfTheStudy) {
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

}  // namespace
}  // namespace zerocount::study
