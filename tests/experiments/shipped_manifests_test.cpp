#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/experiments/manifest_texts.hpp"

namespace zerocount {
namespace {

Study shipped(const std::string& name) {
  return load_study(std::filesystem::path(ZEROCOUNT_MANIFESTS) / (name + ".yaml"));
}

TEST(ShippedManifests, AllAreUnderstoodWithoutWarningsAndNamedLikeTheirFiles) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(ZEROCOUNT_MANIFESTS)) {
    const Study study = load_study(entry.path());
    EXPECT_EQ(study.name, entry.path().stem().string());
    EXPECT_TRUE(study.warnings.empty());
    EXPECT_FALSE(study.description.empty());
    EXPECT_EQ(study.manifest_text.rfind("# ", 0), 0u) << "explained in its own comments";
    ++count;
  }
  EXPECT_GE(count, 6);
}

TEST(ShippedManifests, Figure7HasTheTenTargetsAnd300Samples) {
  const Study study = shipped("paper-fig7");
  ASSERT_EQ(point_count(study), 10);
  for (std::int64_t point = 0; point < 10; ++point) {
    const TrialParameters p = study_trial(study, point, 0).parameters;
    EXPECT_EQ(p.command.targets, std::vector<std::int64_t>{point + 1});
    EXPECT_EQ(p.command.hold * p.controller.sample_rate, 300);
    EXPECT_EQ(p.controller.ki, 3.85e-5);
  }
}

TEST(ShippedManifests, Figure8HasThirtyCountsAnd15000Samples) {
  const Study study = shipped("paper-fig8");
  const TrialParameters p = study_trial(study, 0, 0).parameters;
  EXPECT_EQ(p.command.targets, std::vector<std::int64_t>{30});
  EXPECT_EQ(p.command.hold * p.controller.sample_rate, 15000);
  EXPECT_FALSE(study.retained_trials.empty());
}

TEST(ShippedManifests, TheGainsAreThoseOfThePaperWithWhatItSaw) {
  const Study study = shipped("paper-gains");
  EXPECT_EQ(study.trials, 1000);
  const std::vector<std::pair<double, double>> gains{
      {3.85e-5, 0}, {9.45e-5, 0}, {9.45e-5, 6.21e-4}, {2.08e-4, 0}};
  ASSERT_EQ(study.point_labels.size(), gains.size() + 1);
  for (std::size_t point = 0; point < gains.size(); ++point) {
    const TrialParameters p = study_trial(study, static_cast<std::int64_t>(point), 0).parameters;
    EXPECT_EQ(std::pair(p.controller.ki, p.controller.kp), gains[point]);
  }
  EXPECT_GT(study_trial(study, 4, 0).parameters.controller.ki, 3.01e-4);
  for (const std::string& label : study.point_labels) EXPECT_EQ(study.observed.count(label), 1u) << label;
}

TEST(ShippedManifests, TheStabilityMapIsAGrid) {
  const Study study = shipped("stability-map");
  ASSERT_EQ(study.axes.size(), 2u);
  EXPECT_EQ(study.axes[0].name, "controller.kp");
  EXPECT_EQ(study.axes[1].name, "controller.ki");
}

}  // namespace
}  // namespace zerocount
