// A commanded motion below the encoder's resolution is no motion for the loop, and would count as perfect.
#include "experiments/study/study.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::manifest {
namespace {

constexpr const char* fine_and_coarse = "sweep: {grid: {encoder.fine: [1620000, 3600]}}\n";

std::string commanded(const std::string& command, const std::string& more) {
  return manifest_commanding(command, more);
}

bool is_refused(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const std::string message = refusal_of(text, overrides);
  EXPECT_TRUE(message.empty() || says(message, "does not see this motion")) << message;
  return !message.empty();
}

// The two positions are the same count exactly where rounding says so, whatever their signs.
TEST(UnseenMotions, DifferentTargetsThatRoundToTheSameCountAreRefused) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> position(-3.0, 3.0);
  int refused = 0;
  for (int i = 0; i < 100; ++i) {
    const int fine = std::uniform_int_distribution<int>(100, 10'000'000)(random);
    const double count = 2.0 * std::numbers::pi / fine;
    const double first = position(random) * count;
    const double second = i % 3 == 0 ? first : position(random) * count;
    const bool expected = std::llrint(first / count) == 0 ||
                          (second != first && std::llrint(first / count) == std::llrint(second / count));
    EXPECT_EQ(is_refused(commanded(fmt::format("{{units: si, targets: [{}, {}]}}", first, second),
                                   fmt::format("encoder: {{fine: {}}}\n", fine))),
              expected)
        << first / count << " " << second / count;
    refused += expected ? 1 : 0;
  }
  EXPECT_GT(refused, 20);
  EXPECT_LT(refused, 80);
}

TEST(UnseenMotions, NameTheDesignPointAndTheTarget) {
  const std::string message =
      refusal_of(commanded("{units: si, targets: [1.0e-4, -1.0e-4]}", fine_and_coarse));
  EXPECT_TRUE(says(message,
                   "command.targets.0: the target 0.0001 rad and the position before it, 0 rad, are the same "
                   "count of 0.00174533 rad at point 1 (encoder.fine=3600)",
                   "command.targets.1: the target -0.0001 rad"));
  const std::string shared = refusal_of(
      commanded("{units: si, targets: [1.0e-4]}",
                "sweep: {grid: {controller.ki: [1.0e-5, 2.0e-5, 3.0e-5], encoder.fine: [1620000, 3600]}}\n"));
  EXPECT_TRUE(says(shared, "at point 1 (controller.ki=1e-05, encoder.fine=3600) and 2 others"));
  const std::string all =
      refusal_of(commanded("{units: si, targets: [1.0e-4]}",
                           "encoder: {fine: 3600}\nsweep: {grid: {controller.ki: [1.0e-5, 2.0e-5]}}\n"));
  EXPECT_FALSE(says(all, "at point"));
}

TEST(UnseenMotions, ProfilesSinesAndSequencesAreRefusedToo) {
  const std::string limits = "velocity_limit: 1, acceleration_limit: 1";
  EXPECT_TRUE(is_refused(commanded(
      "{units: si, targets: [1.0e-4], profile: {shape: trapezoidal, " + limits + "}}", fine_and_coarse)));
  const std::string sine =
      "{targets: [0], hold: 1, profile: {shape: sine, frequency: 10, amplitude: 1.0e-4}}";
  EXPECT_TRUE(is_refused(commanded(sine, "encoder: {fine: 3600}\n")));
  EXPECT_FALSE(is_refused(commanded(sine, "encoder: {fine: 1620000}\n")));
  EXPECT_TRUE(is_refused(commanded("{units: si, sequence: {targets: [0.01, 0.0101, 0.2], overrun: 0.1}}",
                                   "encoder: {fine: 3600}\n")));
  EXPECT_FALSE(is_refused(commanded("{units: si, targets: [1.0e-4, 1.0e-4]}", "encoder: {fine: 1620000}\n")));
  EXPECT_FALSE(is_refused(commanded("{units: si, targets: [0]}", "encoder: {fine: 3600}\n")));
}

TEST(UnseenMotions, OverridesAreCheckedToo) {
  const std::string text = commanded("{units: si, targets: [1.0e-4]}", "encoder: {fine: 1620000}\n");
  EXPECT_FALSE(is_refused(text));
  EXPECT_TRUE(is_refused(text, {"encoder.fine=3600"}));
  EXPECT_TRUE(is_refused(text, {"command.targets.0=-1.0e-7"}));
}

// Of drawn targets only a part is lost, which the study may be about.
TEST(UnseenMotions, AWarningStatesTheProportionOfTrials) {
  const double count = 2.0 * std::numbers::pi / 3600;
  const auto drawn = [&](double counts) {
    return commanded(fmt::format("{{units: si, targets: [{{uniform: [0, {}]}}]}}", counts * count),
                     "encoder: {fine: 3600}\n");
  };
  const study::Study study = study_of(drawn(2.0), {"trials=4000"});
  ASSERT_FALSE(study.warnings.empty());
  EXPECT_TRUE(says(study.warnings.back(), "command.targets.0: "));
  EXPECT_TRUE(study.warnings.back().find(" in 24") != std::string::npos ||
              study.warnings.back().find(" in 25") != std::string::npos)
      << study.warnings.back();
  EXPECT_TRUE(is_refused(drawn(0.5), {"trials=4000"}));
}

TEST(UnseenMotions, ARecordedStudyGivesOnlyAWarning) {
  const study::Study study = manifest::recorded_study(
      commanded("{units: si, targets: [1.0e-4]}", "encoder: {fine: 3600}\n"), "old.h5:/manifest", {});
  ASSERT_FALSE(study.warnings.empty());
  EXPECT_TRUE(says(study.warnings.back(), "does not see"));
}

}  // namespace
}  // namespace zerocount::manifest
