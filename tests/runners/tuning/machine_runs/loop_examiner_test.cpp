// Margins hold for every loop in which the machines of a study move.
#include "runners/tuning/machine_runs/loop_examiner.hpp"

#include "experiments/manifest/load_study.hpp"
#include "experiments/study/setting_study.hpp"
#include "experiments/study/study.hpp"
#include "tests/support/test.hpp"

namespace zerocount::tuning {
namespace {

/// Manifest of a machine with this friction and control, and with the inertia of the paper's machine.
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

/// Whether the loop keeps the default stability margins, on machines that slide or that do not.
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
TEST(LoopExaminer, ExaminesTheSlidingLoopIfThereIsNoOther) {
  for (const char* const friction : {"model: coulomb", "model: none"}) {
    for (const bool slides : {false, true}) {
      EXPECT_FALSE(keeps(study_with(friction, "kp: 0, ki: 1000"), slides)) << friction;
      const study::Study good = study_with(friction, stable_everywhere);
      EXPECT_TRUE(keeps(good, slides)) << friction;
      const SmallestMargins margins = LoopExaminer(good, 4).margins_of(good, slides);
      EXPECT_TRUE(std::isfinite(margins.phase.value)) << friction;
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

// The motor alone is eleven times as light as with its load: gains that suit both masses are too high for it.
TEST(LoopExaminer, ExaminesTheMotorAloneInAGap) {
  const auto with = [](const std::string& gap, const std::string& kp) {
    return manifest::parse_study(
        fmt::format(
            "zerocount: 1\nname: gap\nseed: 1\ntrials: 4\ncommand: {{targets: [500], hold: 1.0}}\n"
            "plant: {{inertia: 2.0e-5, presliding_damping: 1.0e-4, load: {{inertia: 2.0e-4, stiffness: "
            "4000, damping: 0.05{}}}}}\nfriction: {{model: none}}\nencoder: {{fine: 1000000}}\n"
            "controller: {{sample_rate: 8000, delay: 1, derivative_cutoff: 300, structure: cascade, "
            "cascade: {{kv: 40, kp: {}, ki: 1}}}}\ngoal: {{band: 1, within: 0.5, moves: 0.9}}\n",
            gap, kp),
        "m.yaml", {});
  };
  const study::Study closed = with("", "0.12");
  const study::Study open = with(", gap: 1.0e-3", "0.12");
  EXPECT_TRUE(keeps(closed, false));
  EXPECT_FALSE(keeps(open, false));
  EXPECT_GE(LoopExaminer(open, 1).shortfall(open, {}, false), 1.0);
  EXPECT_FALSE(LoopExaminer(open, 1).margins_of(open, false).stable);
  const study::Study slow = with(", gap: 1.0e-3", "0.03");
  EXPECT_TRUE(keeps(slow, false));
  const SmallestMargins margins = LoopExaminer(slow, 1).margins_of(slow, false);
  EXPECT_THAT(margins.gain.loop->name, ::testing::HasSubstr("the motor alone in the gap"));
  EXPECT_THAT(margins.delay.loop->name, ::testing::HasSubstr("the motor alone in the gap"));
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
  ASSERT_EQ(margins.settings.size(), 3U);
  ASSERT_TRUE(margins.stable);
  const auto alone_at = [&](std::int64_t condition) {
    const study::Study alone = in_setting(both, condition);
    return LoopExaminer(alone, 1).margins_of(alone, true);
  };
  for (std::int64_t condition = 0; condition < 3; ++condition) {
    const SmallestMargins alone = alone_at(condition);
    const SmallestMargins& found = margins.settings[static_cast<std::size_t>(condition)];
    EXPECT_EQ(found.gain.value, alone.gain.value) << condition;
    EXPECT_EQ(found.phase.value, alone.phase.value) << condition;
    EXPECT_EQ(found.delay.value, alone.delay.value) << condition;
    EXPECT_LE(margins.phase.value, alone.phase.value) << condition;
    EXPECT_LE(margins.gain.value, alone.gain.value) << condition;
    const study::LoopMargins wanted{.gain = std::nullopt, .phase = alone.phase.value, .delay = std::nullopt};
    EXPECT_EQ(LoopExaminer(both, 1).keeps(both, wanted, true), margins.phase.value >= alone.phase.value)
        << condition;
    EXPECT_EQ(LoopExaminer(both, 1).may_keep(both, wanted, true), margins.phase.value >= alone.phase.value)
        << condition;
  }
  EXPECT_LT(margins.phase.value, margins.settings[1].phase.value) << "the light one is not the worst";
  EXPECT_EQ(LoopExaminer(both, 1).margins_of(both, true).machines, 1);
}

study::Study with_margins(const std::string& margins, const std::string& more = "",
                          const std::string& control = "kp: 20, ki: 1000, kd: 0.3") {
  return manifest::parse_study(
      study_text("k1: {lognormal: {median: 110, cv: 0.2}}", control) +
          fmt::format("tune: {{free: {{controller.ki: [1, 1.0e+4]}}, margins: {}}}\n{}", margins, more),
      "m.yaml", {});
}

// The worst of eight machines whose manifests state what is spread: the corners.
TEST(LoopExaminer, SpreadsParametersThatTheStudyDoesNotDraw) {
  const auto alone = [](double inertia, double damping, double torque) {
    return with_margins("{spread: off}",
                        fmt::format("conditions: {{it: {{plant.inertia: {}, plant.presliding_damping: {}, "
                                    "plant.sliding_damping: {}, dac.gain_error: {}}}}}\n",
                                    5.54e-4 * inertia, 0.2 * damping, 1e-3 * damping, torque - 1.0));
  };
  SmallestMargins worst = LoopExaminer(alone(1, 1, 1), 4).margins_of(alone(1, 1, 1), true);
  for (const double inertia : {0.9, 1.1}) {
    for (const double damping : {0.7, 1.3}) {
      for (const double torque : {0.95, 1.05}) {
        const study::Study corner = alone(inertia, damping, torque);
        const SmallestMargins found = LoopExaminer(corner, 4).margins_of(corner, true);
        worst.gain.value = std::min(worst.gain.value, found.gain.value);
        worst.phase.value = std::min(worst.phase.value, found.phase.value);
        worst.delay.value = std::min(worst.delay.value, found.delay.value);
        worst.sensitivity.value = std::max(worst.sensitivity.value, found.sensitivity.value);
      }
    }
  }
  const study::Study spread = with_margins("{gain: 6, spread: typical}");
  const SmallestMargins found = LoopExaminer(spread, 4).margins_of(spread, true);
  EXPECT_NEAR(found.gain.value, worst.gain.value, 1e-9);
  EXPECT_NEAR(found.phase.value, worst.phase.value, 1e-9);
  EXPECT_NEAR(found.delay.value, worst.delay.value, 1e-9);
  EXPECT_NEAR(found.sensitivity.value, worst.sensitivity.value, 1e-9);
  EXPECT_LT(found.phase.value, LoopExaminer(alone(1, 1, 1), 4).margins_of(alone(1, 1, 1), true).phase.value);
}
// What is drawn is not spread as well, and a margin that is wanted is one of every corner.
TEST(LoopExaminer, LeavesDrawnQuantitiesToTheStudy) {
  const auto spread = [](const std::string& more) {
    const study::Study study = with_margins("{gain: 6, spread: typical}", more);
    return LoopExaminer(study, 4).margins_of(study, true).spread;
  };
  EXPECT_EQ(spread("").inertia, 0.1);
  EXPECT_EQ(spread("").damping, 0.3);
  EXPECT_EQ(spread("").torque_constant, 0.05);
  const study::LoopSpread left = spread("dac: {gain_error: {uniform: [-0.01, 0.01]}}\n");
  EXPECT_FALSE(left.torque_constant);
  EXPECT_EQ(left.inertia, 0.1);
}

TEST(LoopExaminer, SensitivityMarginAppliesToTheLargestOfAllLoops) {
  const study::Study study = with_margins("{gain: 6, spread: typical}");
  const double largest = LoopExaminer(study, 4).margins_of(study, true).sensitivity.value;
  for (const double wanted : {0.999 * largest, 1.001 * largest}) {
    const study::LoopMargins margins{
        .gain = std::nullopt, .phase = std::nullopt, .delay = std::nullopt, .sensitivity = wanted};
    EXPECT_EQ(LoopExaminer(study, 4).keeps(study, margins, true), wanted > largest);
  }
}

// Along a line of gains, from no control to far beyond what any loop bears.
TEST(LoopExaminer, ShortfallIsPositiveIfTheMarginsAreMissed) {
  int kept = 0;
  int stable = 0;
  constexpr int steps = 40;
  for (int i = 0; i < steps; ++i) {
    const double factor = std::pow(10.0, 4.0 * i / steps - 2.0);
    const study::Study study =
        with_margins("{gain: 6, sensitivity: 1.8}", "",
                     fmt::format("kp: {}, ki: {}, kd: {}", 20 * factor, 1000 * factor, 0.3 * factor));
    const LoopExaminer examiner(study, 4);
    for (const bool slides : {false, true}) {
      const double shortfall = examiner.shortfall(study, study.tuning->margins, slides);
      const bool keeps = examiner.may_keep(study, study.tuning->margins, slides);
      EXPECT_EQ(shortfall == 0.0, keeps) << factor;
      const bool is_stable = examiner.margins_of(study, slides).stable;
      EXPECT_EQ(shortfall < 1.0, is_stable) << factor;
      kept += keeps ? 1 : 0;
      stable += is_stable ? 1 : 0;
    }
  }
  EXPECT_GT(kept, 5);
  EXPECT_GT(stable, kept);
  EXPECT_LT(stable, 2 * steps);
}

/// Whether the loops of the margins are stable if half of the inertia is a load behind a spring.
/// @param factor factor of the machine's inertia
bool is_stable_with_mode(double frequency, double factor = 1.0) {
  const double half = 0.5 * 5.54e-4 * factor;
  const double rate = 2.0 * std::numbers::pi * frequency;
  const double swinging = 0.5 * half;
  const study::Study swung = with_margins(
      "off",
      fmt::format("conditions: {{it: {{plant.inertia: {}, plant.load.inertia: {}, plant.load.stiffness: "
                  "{}, plant.load.damping: {}}}}}\n",
                  half, half, swinging * rate * rate, 0.02 * swinging * rate));
  return LoopExaminer(swung, 4).margins_of(swung, true).stable;
}

// At the lowest mode that is borne the loops are stable, and a little below it one is not.
TEST(LoopExaminer, FindsTheLowestResonanceThatTheLoopsTolerate) {
  const study::Study study = with_margins("off");
  const std::optional<double> lowest = LoopExaminer(study, 4).lowest_mode(study, true);
  ASSERT_TRUE(lowest);
  EXPECT_TRUE(is_stable_with_mode(*lowest));
  EXPECT_FALSE(is_stable_with_mode(*lowest / 1.05));
  const study::Study loaded = with_margins("off", "conditions: {it: {plant.load.inertia: 1.0e-4}}\n");
  EXPECT_FALSE(LoopExaminer(loaded, 4).lowest_mode(loaded, true)) << "it has a mode already";
}

TEST(LoopExaminer, LowestResonanceIsToleratedByEachMachineOfTheSpread) {
  const study::Study plain = with_margins("off");
  const study::Study spread = with_margins("{spread: {inertia: 0.8}}");
  const std::optional<double> of_one = LoopExaminer(plain, 4).lowest_mode(plain, true);
  const std::optional<double> of_all = LoopExaminer(spread, 4).lowest_mode(spread, true);
  ASSERT_TRUE(of_one && of_all);
  EXPECT_GT(*of_all, *of_one) << "with less inertia the same gains tolerate less";
  EXPECT_TRUE(is_stable_with_mode(*of_all, 0.2));
  EXPECT_FALSE(is_stable_with_mode(*of_all / 1.05, 0.2));
  EXPECT_TRUE(is_stable_with_mode(*of_one));
}

TEST(LoopExaminer, ListsMarginsBySettingOnlyIfTheStudyHasSettings) {
  const study::Study plain = with_margins("off");
  EXPECT_TRUE(LoopExaminer(plain, 4).margins_of(plain, true).settings.empty());
  const study::Study single = with_margins("off", "conditions: {it: {plant.inertia: 5.0e-4}}\n");
  EXPECT_EQ(LoopExaminer(single, 4).margins_of(single, true).settings.size(), 1U);
}

}  // namespace
}  // namespace zerocount::tuning
