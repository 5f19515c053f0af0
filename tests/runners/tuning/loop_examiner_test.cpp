// Margins hold for every loop in which the machines of a study move.
#include "runners/tuning/loop_examiner.hpp"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "experiments/manifest/load_study.hpp"

namespace zerocount::tuning {
namespace {

/// A machine with this friction and control, of the paper's inertia.
study::Study study_with(const std::string& friction, const std::string& controller) {
  return manifest::parse_study(
      fmt::format("zerocount: 1\nname: loops\nseed: 1\ntrials: 4\ncommand: {{targets: [500], hold: 1.0}}\n"
                  "plant: {{presliding_damping: 0.2, sliding_damping: 1.0e-3}}\nfriction: {{{}}}\n"
                  "controller: {{units: si, sample_rate: 4000, delay: 1, {}}}\n"
                  "goal: {{band: 1, within: 0.5, moves: 0.9}}\n",
                  friction, controller),
      "m.yaml", {});
}

/// Whether default margins are kept, by machines that slide or not.
bool keeps(const study::Study& study, bool slides) {
  LoopExaminer examiner(study, 4);
  EXPECT_EQ(examiner.may_keep(study, {}, slides), examiner.keeps(study, {}, slides));
  return LoopExaminer(study, 4).keeps(study, {}, slides);
}

// Integral action alone is stable about a spring and unstable on a sliding rotor.
constexpr const char* stable_at_rest_only = "kp: 0, ki: 1000";
constexpr const char* stable_everywhere = "kp: 20, ki: 100, kd: 0.3";

TEST(LoopExaminer, ExaminesTheSlidingLoopOfMachinesThatSlide) {
  for (const char* const friction :
       {"k1: 110", "model: dahl, sigma0: 860", "model: lugre, sigma0: 860, sigma1: 0.2",
        "model: gms, gms: {stiffness: [500, 360], weight: [0.5, 0.5]}"}) {
    const bool is_damped = std::string_view(friction).find("gms") == std::string_view::npos;
    const study::Study study = study_with(friction, stable_at_rest_only);
    EXPECT_EQ(keeps(study, false), is_damped) << friction;
    EXPECT_FALSE(keeps(study, true)) << friction;
    EXPECT_FALSE(LoopExaminer(study, 4).margins_of(study, true).stable) << friction;
    EXPECT_TRUE(keeps(study_with(friction, stable_everywhere), true)) << friction;
  }
}

// Coulomb friction has no stiffness before it slides, and an air bearing always slides.
TEST(LoopExaminer, ExaminesTheSlidingLoopWhereThereIsNoOther) {
  for (const char* const friction : {"model: coulomb", "model: none"}) {
    for (const bool slides : {false, true}) {
      EXPECT_FALSE(keeps(study_with(friction, "kp: 0, ki: 1000"), slides)) << friction;
      const study::Study good = study_with(friction, stable_everywhere);
      EXPECT_TRUE(keeps(good, slides)) << friction;
      const SmallestMargins margins = LoopExaminer(good, 4).margins_of(good, slides);
      EXPECT_TRUE(std::isfinite(margins.phase)) << friction;
      EXPECT_TRUE(margins.sliding) << friction;
    }
  }
}

TEST(LoopExaminer, ExaminesTheLoopAtStandstill) {
  const char* const gains =
      "kp: 0, ki: 1000, standstill: {band: 2, dwell: 0.01, kp: 5.0e+3, ki: 1000, kd: 0}";
  EXPECT_TRUE(keeps(study_with("k1: 110", stable_at_rest_only), false));
  EXPECT_FALSE(keeps(study_with("k1: 110", gains), false));
}

// The bristle is so stiff that its loop needs hours.
TEST(LoopExaminer, DoesNotTakeASlowPoleForAnUnstableOne) {
  for (const char* const sigma0 : {"1.0e+6", "1.0e+8", "1.0e+10"}) {
    const std::string friction = fmt::format("model: lugre, sigma0: {}, sigma1: 50", sigma0);
    EXPECT_TRUE(keeps(study_with(friction, "kp: 20, ki: 1, kd: 0.3"), true)) << sigma0;
  }
}

}  // namespace
}  // namespace zerocount::tuning
