// Loops that nobody would build on purpose are told at the worst point, with the margins of trial_loops().
#include "analysis/theory/loop_plausibility.hpp"

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/theory/trial_loops.hpp"
#include "core/theory/margins.hpp"
#include "experiments/manifest/load_study.hpp"

namespace zerocount::theory {
namespace {

study::Study study_with(const std::string& target, const std::string& controller,
                        const std::string& more = "") {
  return manifest::parse_study(
      fmt::format("zerocount: 1\nname: doubt\nseed: 1\ntrials: 2\ncommand: {{targets: "
                  "[{}]}}\ncontroller: {{{}}}\n{}",
                  target, controller, more),
      "m.yaml", {});
}

bool contains(const std::vector<std::string>& lines, const std::string& text) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

/// The smallest phase margin at rest of stable loops, °; NaN if a loop is unstable or has none.
double smallest_phase_margin(const study::Study& study) {
  double smallest = std::numeric_limits<double>::infinity();
  const trial::TrialParameters p = study::study_trial(study, 0, 0).parameters;
  for (const TrialLoop& loop : trial_loops(p)) {
    if (loop.slides) continue;
    if (stability_of(loop.loop, p.command.hold) != LoopStability::stable)
      return std::numeric_limits<double>::quiet_NaN();
    const double margin = stability_margins(loop.loop).phase.value;
    if (!std::isnan(margin)) smallest = std::min(smallest, std::abs(margin));
  }
  return smallest;
}

// Random PID loops with delays.
TEST(LoopPlausibility, APhaseMarginIsAtLeastTwentyDegrees) {
  std::mt19937_64 random(17);
  const auto between = [&](double low, double high) {
    return std::exp(std::uniform_real_distribution(std::log(low), std::log(high))(random));
  };
  int doubtful = 0;
  int sound = 0;
  for (int i = 0; i < 150; ++i) {
    const study::Study study = study_with(
        "5", fmt::format("kp: {}, ki: {}, kd: {}, delay: {}", between(1e-4, 5e-3), between(1e-6, 1e-4),
                         between(1e-3, 2e-2), std::uniform_int_distribution(0, 2)(random)));
    const double margin = smallest_phase_margin(study);
    if (!std::isfinite(margin)) continue;
    const std::vector<std::string> lines = doubtful_loops(study);
    EXPECT_EQ(contains(lines, "phase margin is"), margin < 20.0) << margin;
    if (margin < 20.0) {
      EXPECT_TRUE(contains(lines, "point 0 (all): at k1")) << lines.front();
    }
    ++(margin < 20.0 ? doubtful : sound);
  }
  EXPECT_GT(doubtful, 5);
  EXPECT_GT(sound, 5);
}

TEST(LoopPlausibility, TheWorstPointIsTold) {
  const study::Study study =
      study_with("5", "kp: 6.21e-4", "sweep: {grid: {controller.ki: [2.0e-5, 9.45e-5, 3.0e-4, 5.0e-5]}}\n");
  const std::vector<std::string> lines = doubtful_loops(study);
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines.front().starts_with("point 2 (controller.ki=0.0003): at k1 the phase margin is -"))
      << lines.front();
  EXPECT_TRUE(contains(lines, "the loop is unstable"));
}

// The paper's: between criteria (6) and (7) some histories are stable; beyond (7) none.
TEST(LoopPlausibility, IntegralControlAloneIsDoubtedBeyondCriterionSeven) {
  for (const double ki : {1e-5, 3.85e-5, 9.45e-5, 2.08e-4})
    EXPECT_TRUE(doubtful_loops(study_with("30", fmt::format("ki: {}", ki))).empty()) << ki;
  EXPECT_TRUE(contains(doubtful_loops(study_with("30", "ki: 4.0e-4")), "at k1 + k2 the phase margin"));
}

// The pre-sliding range is 694 counts: the loop with integral control alone is unstable while it slides.
TEST(LoopPlausibility, AMoveBeyondThePreslidingRangeNeedsALoopThatIsStableWhileItSlides) {
  const char* const text = "longer than the pre-sliding range of 694.4 counts";
  for (const char* const shape : {"step", "trapezoidal", "s_curve"}) {
    const auto told = [shape](const std::string& targets, const std::string& controller,
                              const std::string& what) {
      return contains(
          doubtful_loops(manifest::parse_study(
              fmt::format("zerocount: 1\nname: doubt\nseed: 1\ntrials: 2\ncommand: {{targets: [{}], "
                          "profile: {{shape: {}}}}}\ncontroller: {{{}}}\n",
                          targets, shape, controller),
              "m.yaml", {})),
          what);
    };
    EXPECT_FALSE(told("694", "ki: 3.85e-5", text)) << shape;
    EXPECT_TRUE(told("695", "ki: 3.85e-5", text)) << shape;
    EXPECT_TRUE(told("500, -300", "ki: 3.85e-5", "a move of 800 counts")) << shape;
    EXPECT_FALSE(told("695", "kp: 6.0e-4, ki: 1.0e-6, kd: 1.0e-2", text)) << shape;
    // A coarse phase makes the long moves.
    EXPECT_FALSE(told("5000", "ki: 3.85e-5, coarse: {coarse_beyond: 300, kp: 6.0e-4, kd: 1.0e-2}", text))
        << shape;
  }
}

TEST(LoopPlausibility, ADelayOfASampleMoreIsEndured) {
  // Far above the resonance the crossover is so fast that one sample costs more than the margin.
  const study::Study study = study_with("5", "kd: 1.28e-2, ki: 3.85e-5");
  const std::vector<std::string> lines = doubtful_loops(study);
  EXPECT_TRUE(contains(lines, "samples more makes the loop unstable")) << lines.size();
}

TEST(LoopPlausibility, AnOpenLoopHasNone) {
  EXPECT_TRUE(
      doubtful_loops(manifest::parse_study(
                         "zerocount: 1\nname: open\nseed: 1\ntrials: 1\ncommand: {torque: {levels: [0.1]}}\n",
                         "m.yaml", {}))
          .empty());
}

}  // namespace
}  // namespace zerocount::theory
