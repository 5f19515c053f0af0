// Moves that are said to be out of reach are: no trial of a random loop makes one.
#include "analysis/theory/move_plausibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/theory/goal_plausibility.hpp"
#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "tests/core/loop/random_blocks.hpp"

namespace zerocount::theory {
namespace {

/// A slide of 1 kg with a fast PID, which a manifest's other sections complete.
study::Study slide(const std::string& rest, const std::string& model, double breakaway,
                   const std::string& encoder = "resolution: 1.0e-7") {
  return manifest::parse_study(
      fmt::format(
          "zerocount: 1\nname: slide\naxis: linear\nseed: 1\ntrials: 4\n"
          "plant: {{inertia: 1, presliding_damping: 200, sliding_damping: 5}}\n"
          "friction: {{model: {0}, breakaway: {1:.6g}, coulomb_ratio: 0.8, stribeck_velocity: 1.0e-3, k1: "
          "{2:.6g}, k2: {2:.6g}, beta: 1.0e+5, lambda: 1.0e+7, sigma0: {2:.6g}, sigma1: 300, gms: "
          "{{stiffness: [{2:.6g}, {3:.6g}], weight: [0.6, 0.4], attraction: 500}}}}\n"
          "encoder: {{{4}}}\n"
          "controller: {{units: si, sample_rate: 4000, kp: 2.0e+4, ki: 4.0e+5, kd: 200}}\n{5}",
          model, breakaway, 1e4 * breakaway, 3e4 * breakaway, encoder, rest),
      "m.yaml", {});
}

bool is_told(const study::Study& study, const std::string& what) {
  const std::vector<std::string> lines = doubtful_goals(study);
  return std::ranges::any_of(lines,
                             [&](const std::string& line) { return line.find(what) != std::string::npos; });
}

/// Whether the last move of a trial is within the tolerance for good in time.
bool meets(const study::Study& study, std::int64_t trial = 0) {
  const trial::TrialOutcome outcome = trial::run_trial(study::study_trial(study, 0, trial).parameters);
  return outcome.moves.back().tolerance_settling_times[0] <= study.goals.front().within;
}

constexpr std::array<const char*, 7> words_of_laws{"none", "coulomb", "presliding", "spring",
                                                   "dahl", "lugre",   "gms"};

TEST(MovePlausibility, NoTrialMakesAMoveForWhichTheTorqueIsTooSmall) {
  testing::RandomBlocks draw(11);
  int told = 0;
  int made = 0;
  for (int i = 0; i < 140; ++i) {
    const char* const law = words_of_laws[static_cast<std::size_t>(i) % words_of_laws.size()];
    const double distance = draw.log_uniform(1e-4, 0.1);
    const double range = draw.log_uniform(3.0, 100.0);
    const double breakaway = range * draw.log_uniform(0.02, 1.5);
    const double torque = draw.chance(0.5) ? 0.0 : range * draw.uniform(-0.9, 0.9);
    const double within = 2.0 * std::sqrt(distance / range) * draw.log_uniform(0.5, 30.0);
    const study::Study study = slide(
        fmt::format("dac: {{bits: 20, range: {:.6g}}}\ndisturbance: {{torque: {:.6g}}}\n"
                    "command: {{targets: [{}], hold: {:.6g}}}\n"
                    "goal: {{tolerance: {:.6g}, within: {:.6g}, moves: 0.9}}\n",
                    range, torque, std::llround(distance / 1e-7), within + 0.3, 0.01 * distance, within),
        law, breakaway);
    const bool is_impossible = is_told(study, " s at least") || is_told(study, "never ends");
    const bool is_made = meets(study);
    EXPECT_FALSE(is_impossible && is_made) << law << " " << distance << " " << range << " " << breakaway;
    told += is_impossible ? 1 : 0;
    made += is_made ? 1 : 0;
  }
  EXPECT_GT(told, 30);
  EXPECT_GT(made, 15);
}

// Of bang-bang: a range of 10 N moves 1 kg by 25 mm in 0.1 s.
TEST(MovePlausibility, TheTimeCountsInertiaLoadAndRange) {
  const auto told = [](const std::string& plant, double range, double within) {
    study::Study study = manifest::parse_study(
        fmt::format(
            "zerocount: 1\nname: s\naxis: linear\nseed: 1\ntrials: 2\nplant: {{presliding_damping: 0, "
            "{}}}\nfriction: {{model: none}}\nencoder: {{resolution: 1.0e-7}}\n"
            "dac: {{bits: 24, range: {:.6g}}}\ncontroller: {{units: si, delay: 0, kp: 100, ki: 0}}\n"
            "command: {{units: si, targets: [0.025], hold: 1}}\n"
            "goal: {{tolerance: 1.0e-6, within: {:.6g}, moves: 0.9}}\n",
            plant, range, within),
        "m.yaml", {});
    return is_told(study, " s at least");
  };
  EXPECT_TRUE(told("inertia: 1", 10.0, 0.099));
  EXPECT_FALSE(told("inertia: 1", 10.0, 0.101));
  EXPECT_FALSE(told("inertia: 1", 10.3, 0.099));
  EXPECT_TRUE(told("inertia: 0.7, load: {inertia: 0.3, stiffness: 1.0e+5, damping: 5}", 10.0, 0.099));
  EXPECT_FALSE(told("inertia: 0.7, load: {inertia: 0.3, stiffness: 1.0e+5, damping: 5}", 10.0, 0.101));
}

TEST(MovePlausibility, ATorqueAboveTheRangeIsToldWithAndWithoutAGoal) {
  const std::string command = "command: {targets: [1000], hold: 0.3}\n";
  const std::string goal = "goal: {tolerance: 1.0e-6, within: 0.2, moves: 0.9}\n";
  for (const double torque : {-9.0, 9.0}) {
    for (const std::string& judged : {goal, std::string()}) {
      const auto with = [&](double range) {
        return slide(fmt::format("dac: {{bits: 20, range: {}}}\ndisturbance: {{torque: {}}}\n{}{}", range,
                                 torque, command, judged),
                     "lugre", 2.0);
      };
      EXPECT_TRUE(is_told(with(6.0), "nothing holds the axis"));
      EXPECT_TRUE(is_told(with(8.0), "only friction"));
      EXPECT_FALSE(is_told(with(9.5), "the disturbance (torque and ripple)"));
      if (!judged.empty()) {
        EXPECT_FALSE(meets(with(6.0)));
      }
    }
  }
}

// Gravity is a ripple of one period, and its phase may be drawn: for some machines it is too much.
TEST(MovePlausibility, ARippleIsJudgedAtTheTargetUnderEachCondition) {
  const auto with = [](const std::string& phase, const std::string& moves) {
    return manifest::parse_study(
        fmt::format(
            "zerocount: 1\nname: joint\nseed: 1\ntrials: 40\n"
            "plant: {{inertia: 0.5, sliding_damping: 12}}\n"
            "friction: {{model: lugre, sigma0: 3.0e+4, sigma1: 70, breakaway: 2}}\n"
            "encoder: {{fine: 1000000, coarse: 1000000}}\ndac: {{bits: 16, range: 30}}\n"
            "controller: {{structure: cascade, sample_rate: 4000, cascade: {{kv: 30, kp: 100, ki: 3000}}}}\n"
            "disturbance: {{ripple: [{{amplitude: 8, periods: 1, phase: {}}}]}}\n"
            "conditions: {{empty: {{}}, loaded: {{disturbance.ripple.0.amplitude: 45}}}}\n"
            "command: {{units: si, targets: [0.1], hold: 1}}\n"
            "goal: {{tolerance: 1.0e-4, within: 0.8, moves: {}}}\n",
            phase, moves),
        "m.yaml", {});
  };
  EXPECT_TRUE(is_told(with("1.5", "0.9"), "under condition loaded: at the target of move 0 the disturbance"));
  EXPECT_FALSE(is_told(with("0", "0.9"), "at the target"));
  EXPECT_TRUE(is_told(with("{uniform: [0, 6.283]}", "0.9"), "moves examined)"));
  EXPECT_FALSE(is_told(with("{uniform: [0, 6.283]}", "0.1"), "at the target"));
}

TEST(MovePlausibility, AGoalLeavesTheProfileItsTime) {
  testing::RandomBlocks draw(12);
  int told = 0;
  for (int i = 0; i < 40; ++i) {
    const double within = draw.uniform(0.05, 0.4);
    const char* const shape = draw.chance(0.5) ? "s_curve, jerk_limit: 200" : "trapezoidal";
    const study::Study study =
        slide(fmt::format("dac: {{bits: 24, range: 500}}\n"
                          "command: {{units: si, targets: [0.02, 0.05], hold: 0.6, profile: {{shape: {}, "
                          "velocity_limit: 0.2, acceleration_limit: 5}}}}\n"
                          "goal: {{tolerance: 2.0e-5, within: {:.6g}, moves: 0.9, \"on\": [1]}}\n",
                          shape, within),
              "lugre", 5.0);
    const bool is_short = is_told(study, "by its profile");
    EXPECT_FALSE(is_short && meets(study)) << within;
    told += is_short ? 1 : 0;
    // 0.03 m at 0.2 m/s at most.
    if (within < 0.15 || within > 0.24) {
      EXPECT_EQ(is_short, within < 0.15) << within;
    }
  }
  EXPECT_GT(told, 10);
}

TEST(MovePlausibility, ABandIsLessThanHalfAStep) {
  const auto told = [](const std::string& goal) {
    return is_told(
        slide("dac: {bits: 24, range: 500}\ncommand: {units: si, targets: [0, 1.0e-3, 1.02e-3], hold: "
              "0.3}\ngoals: {small: {\"on\": [2], " +
                  goal + ", within: 0.2, moves: 0.9}}\n",
              "lugre", 5.0),
        "half of the step of move 2");
  };
  EXPECT_TRUE(told("tolerance: 1.0e-5"));
  EXPECT_TRUE(told("tolerance: 5.0e-5"));
  EXPECT_FALSE(told("tolerance: 0.99e-5"));
  EXPECT_TRUE(told("band: 100"));
  EXPECT_FALSE(told("band: 99"));
}

TEST(MovePlausibility, NoTrialMeetsATargetThatTheEncoderMisplaces) {
  testing::RandomBlocks draw(13);
  int told = 0;
  int met = 0;
  for (int i = 0; i < 30; ++i) {
    const double tolerance = draw.log_uniform(3e-7, 3e-6);
    const study::Study study = slide(
        fmt::format("dac: {{bits: 24, range: 500}}\ncommand: {{targets: [{}], hold: 0.5}}\n"
                    "goal: {{tolerance: {:.6g}, within: 0.4, moves: 0.9}}\n",
                    static_cast<int>(draw.uniform(200, 3000)), tolerance),
        "lugre", 5.0, "resolution: 1.0e-7, fine_errors: {interpolation: 10, interpolation_period: 400}");
    const bool is_misplaced = is_told(study, "misplace the target");
    const bool is_met = meets(study);
    EXPECT_FALSE(is_misplaced && is_met) << tolerance;
    told += is_misplaced ? 1 : 0;
    met += is_met ? 1 : 0;
  }
  EXPECT_GT(told, 5);
  EXPECT_GT(met, 5);
}

}  // namespace
}  // namespace zerocount::theory
