// Margins hold for every loop in which the machines of a study move.
#include "runners/tuning/loop_examiner.hpp"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "experiments/manifest/load_study.hpp"
#include "experiments/study/condition_study.hpp"

namespace zerocount::tuning {
namespace {

/// A machine with this friction and control, of the paper's inertia.
std::string study_text(const std::string& friction, const std::string& controller) {
  return fmt::format(
      "zerocount: 1\nname: loops\nseed: 1\ntrials: 12\ncommand: {{targets: [500], hold: 1.0}}\n"
      "plant: {{presliding_damping: 0.2, sliding_damping: 1.0e-3}}\nfriction: {{{}}}\n"
      "controller: {{units: si, sample_rate: 4000, delay: 1, {}}}\n"
      "goal: {{band: 1, within: 0.5, moves: 0.9}}\n",
      friction, controller);
}
study::Study study_with(const std::string& friction, const std::string& controller) {
  return manifest::parse_study(study_text(friction, controller), "m.yaml", {});
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

// A condition is one more machine: the margins are the smallest, and one condition that does not keep them is
// enough. What every machine bears does not part machines that differ in their stiffness alone.
TEST(LoopExaminer, ExaminesTheLoopsUnderEveryCondition) {
  const std::string friction = "k1: {lognormal: {median: 110, cv: 0.2}}";
  const std::string control = "kp: 20, ki: 1000, kd: 0.3";
  const auto under = [&](const std::string& inertia, const std::string& more) {
    std::string text = study_text(friction, control) + more;
    const std::string plant = "plant: {";
    text.insert(text.find(plant) + plant.size(), "inertia: " + inertia + ", ");
    return manifest::parse_study(text, "m.yaml", {});
  };
  const study::Study both = under(
      "5.54e-4", "conditions: {heavy: {plant.inertia: 1.5e-3}, light: {}, delayed: {controller.delay: 3}}\n");
  const SmallestMargins margins = LoopExaminer(both, 1).margins_of(both, true);
  ASSERT_EQ(margins.conditions.size(), 3U);
  ASSERT_TRUE(margins.stable);
  const auto alone_at = [&](std::int64_t condition) {
    const study::Study alone = under_condition(both, condition);
    return LoopExaminer(alone, 1).margins_of(alone, true);
  };
  for (std::int64_t condition = 0; condition < 3; ++condition) {
    const SmallestMargins alone = alone_at(condition);
    const SmallestMargins& found = margins.conditions[static_cast<std::size_t>(condition)];
    EXPECT_EQ(found.gain, alone.gain) << condition;
    EXPECT_EQ(found.phase, alone.phase) << condition;
    EXPECT_EQ(found.delay, alone.delay) << condition;
    EXPECT_LE(margins.phase, alone.phase) << condition;
    EXPECT_LE(margins.gain, alone.gain) << condition;
    const study::LoopMargins wanted{.gain = std::nullopt, .phase = alone.phase, .delay = std::nullopt};
    EXPECT_EQ(LoopExaminer(both, 1).keeps(both, wanted, true), margins.phase >= alone.phase) << condition;
    EXPECT_EQ(LoopExaminer(both, 1).may_keep(both, wanted, true), margins.phase >= alone.phase) << condition;
  }
  EXPECT_LT(margins.phase, margins.conditions[1].phase) << "the light one is not the worst";
  EXPECT_EQ(LoopExaminer(both, 1).margins_of(both, true).machines, 1);
}

}  // namespace
}  // namespace zerocount::tuning
