// Goals that no loop can meet are told, with the bound that keeps them from it.
#include "analysis/theory/goal_plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/theory/trial_loops.hpp"
#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"

namespace zerocount::theory {
namespace {

constexpr double count = 1e-8;  // m

/// A linear axis with k1 = 1e6 N/m and counts of 10 nm.
study::Study study_asking(const std::string& goal, const std::string& more = "",
                          const std::string& encoder = "resolution: 1.0e-8") {
  return manifest::parse_study(
      fmt::format(
          "zerocount: 1\nname: goals\naxis: linear\nseed: 1\ntrials: 2\n{}\n"
          "plant: {{inertia: 2, sliding_damping: 10, presliding_damping: 300}}\n"
          "friction: {{k1: 1.0e+6, k2: 4.0e+6, beta: 1.0e+6, breakaway: 10, alpha: 0, coulomb_ratio: 1, "
          "lambda: 1.0e+7, stribeck_velocity: 1.0e-3}}\n"
          "encoder: {{{}}}\ncommand: {{targets: [20], hold: 0.2}}\n"
          "controller: {{units: si, sample_rate: 4000, ki: 1.0e+7, kp: 1.0e+5, kd: 100}}\n{}",
          goal, encoder, more),
      "m.yaml", {});
}

std::vector<std::string> doubts(const std::string& goal, const std::string& dac = "bits: 20, range: 50",
                                const std::string& encoder = "resolution: 1.0e-8") {
  const std::string moves = goal.find("moves:") == std::string::npos ? ", moves: 0.5" : "";
  return doubtful_goals(study_asking("goal: {" + goal + moves + "}", "dac: {" + dac + "}\n", encoder));
}

class GoalPlausibility : public ::testing::Test {
 protected:
  double log_uniform(double low, double high) {
    return std::exp(std::uniform_real_distribution(std::log(low), std::log(high))(random_));
  }
  /// Just inside or outside of 1.
  double near_one() { return std::bernoulli_distribution()(random_) ? 1.02 : 0.98; }
  std::mt19937_64& random() { return random_; }
  static constexpr int rounds = 40;

 private:
  std::mt19937_64 random_{7};
};

TEST_F(GoalPlausibility, AToleranceIsAtLeastHalfACount) {
  for (int i = 0; i < rounds; ++i) {
    const double resolution = log_uniform(1e-9, 1e-7);
    const double ratio = near_one();
    const auto told = doubts(fmt::format("tolerance: {:.17g}, within: 0.1", ratio * 0.5 * resolution),
                             "bits: 24, range: 50", fmt::format("resolution: {:.17g}", resolution));
    if (ratio > 1.0) {
      EXPECT_TRUE(told.empty()) << told.front();
      continue;
    }
    ASSERT_EQ(told.size(), 1U) << resolution;
    EXPECT_TRUE(told.front().starts_with("point 0 (all): a tolerance of ")) << told.front();
    EXPECT_NE(told.front().find(fmt::format("expected at least {:.3g} m", 0.5 * resolution)),
              std::string::npos)
        << told.front();
  }
}

// (1 - 2 Q((b + 1/2)/noise))^n, n the samples from `within` on.
TEST_F(GoalPlausibility, ABandHoldsTheNoiseOfAnAxisThatStandsStill) {
  int told = 0;
  for (int i = 0; i < rounds; ++i) {
    const int band = std::uniform_int_distribution(0, 3)(random());
    const double noise = log_uniform(0.1, 0.4) * (band + 0.5);
    const double within = log_uniform(0.01, 0.19);
    const int samples = 800 - static_cast<int>(std::floor(within * 4000.0));
    const double inside = std::erf((band + 0.5) / noise / std::numbers::sqrt2);
    const double rate = std::pow(inside, samples);
    const double moves = std::clamp(rate * near_one(), 0.001, 0.999);
    const auto lines = doubts(fmt::format("band: {}, within: {:.17g}, moves: {:.17g}", band, within, moves),
                              "bits: 20, range: 50",
                              fmt::format("resolution: 1.0e-8, fine_errors: {{noise: {:.17g}}}", noise));
    ASSERT_EQ(lines.size(), moves > rate ? 1U : 0U) << rate << " " << moves;
    if (lines.empty()) continue;
    ++told;
    EXPECT_NE(lines.front().find(fmt::format("at most {:.3g} % of the moves", 100.0 * rate)),
              std::string::npos)
        << lines.front();
  }
  EXPECT_GT(told, rounds / 5);
  EXPECT_LT(told, rounds * 4 / 5);
}

// The bound is one: no trial of a loop, stable and ideal but for its noise, does better by more than chance.
TEST_F(GoalPlausibility, MovesMeetABandNoOftenerThanTold) {
  constexpr int trials = 400;
  for (const double noise : {0.14, 0.15, 0.16}) {
    const study::Study study = manifest::parse_study(
        fmt::format("zerocount: 1\nname: noise\nseed: 3\ntrials: {}\n"
                    "encoder: {{fine_errors: {{noise: {}}}}}\ncommand: {{targets: [5], hold: 0.2}}\n"
                    "friction: {{alpha: 0}}\ncontroller: {{ki: 2.0e-5}}\n",
                    trials, noise),
        "m.yaml", {});
    int met = 0;
    for (int i = 0; i < trials; ++i) {
      const trial::TrialOutcome outcome = trial::run_trial(study::study_trial(study, 0, i).parameters);
      met += outcome.moves[0].bands[0].settling_time <= 0.1 ? 1 : 0;
    }
    const double bound = highest_rate_within_band(0.0, noise, 200.0);
    EXPECT_LE(met, trials * bound + 4.0 * std::sqrt(trials * bound * (1.0 - bound))) << noise;
  }
}

TEST_F(GoalPlausibility, OneCodeMovesTheAxisByLessThanTheBand) {
  for (int i = 0; i < rounds; ++i) {
    const int band = std::uniform_int_distribution(0, 3)(random());
    const bool tolerance = std::bernoulli_distribution()(random());
    const double ratio = near_one();
    const double width = (2.0 * band + 1.0) * count;
    const std::string goal = tolerance ? fmt::format("tolerance: {:.17g}, within: 0.1", 0.5 * width)
                                       : fmt::format("band: {}, within: 0.1", band);
    const std::string dac = fmt::format("bits: 24, resolution: {:.17g}", ratio * 5e6 * width);
    const auto lines = doubts(goal, dac);
    ASSERT_EQ(lines.size(), ratio > 1.0 ? 1U : 0U) << goal << (lines.empty() ? "" : lines.front());
    if (!lines.empty()) {
      EXPECT_NE(lines.front().find(fmt::format("a code of at most {:.3g} N", 5e6 * width)), std::string::npos)
          << lines.front();
    }
    EXPECT_TRUE(doubts(goal, dac + ", sigma_delta: true").empty());
  }
}

// Of a spring that does not soften, so that the loop is linear but for its rounding.
TEST_F(GoalPlausibility, NoiseMovesTheAxisByTheLinearLoop) {
  for (const double bandwidth : {std::numeric_limits<double>::infinity(), 100.0}) {
    for (const double noise : {5.0, 20.0}) {
      const std::string of_bandwidth =
          std::isfinite(bandwidth) ? fmt::format(", noise_bandwidth: {}", bandwidth) : "";
      const study::Study study =
          study_asking("", "dac: {bits: 24, range: 50}\n",
                       fmt::format("resolution: 1.0e-8, fine_errors: {{noise: {}{}}}", noise, of_bandwidth));
      trial::TrialParameters p = study::study_trial(study, 0, 0).parameters;
      p.friction.uniform.k2 = 0.0;
      p.command.hold = 5.0;
      const double predicted =
          noise * count * response_to_noise(trial_loops(p).front().loop, NoiseAt::axis, bandwidth).gain;
      double sum = 0.0;
      double squares = 0.0;
      int samples = 0;
      trial::TrialObservers observers;
      observers.sample = [&](const trial::SampleRecord& sample) {
        if (sample.t < 0.5) return;
        sum += sample.theta;
        squares += sample.theta * sample.theta;
        ++samples;
      };
      trial::run_trial(p, observers);
      const double mean = sum / samples;
      EXPECT_NEAR(std::sqrt(squares / samples - mean * mean) / predicted, 1.0, 0.1)
          << noise << " " << bandwidth;
    }
  }
}

bool is_told(const std::vector<std::string>& lines, const std::string& what) {
  return std::ranges::any_of(lines,
                             [&](const std::string& line) { return line.find(what) != std::string::npos; });
}

/// The best proportion of moves whose last `samples` are within the tolerance, of the loops at rest.
double rate_within_tolerance(const trial::TrialParameters& p, double noise, double tolerance,
                             double samples) {
  double best = 0.0;
  for (const TrialLoop& loop : trial_loops(p)) {
    if (loop.slides) continue;
    const NoiseResponse response =
        response_to_noise(loop.loop, NoiseAt::axis, std::numeric_limits<double>::infinity());
    const double inside = std::erf(tolerance / (noise * count * response.gain) / std::numbers::sqrt2);
    best = std::max(best, std::pow(inside, std::max(samples / response.correlated_samples, 1.0)));
  }
  return best;
}

TEST_F(GoalPlausibility, AToleranceHoldsTheMotionByNoiseAtAllSamples) {
  for (int i = 0; i < rounds; ++i) {
    const double noise = log_uniform(2, 20);
    const std::string encoder = fmt::format("resolution: 1.0e-8, fine_errors: {{noise: {:.17g}}}", noise);
    const trial::TrialParameters p =
        study::study_trial(study_asking("", "dac: {bits: 20, range: 50}\n", encoder), 0, 0).parameters;
    const double tolerance = log_uniform(1.5, 6) * count * noise * 0.1;
    const double rate = rate_within_tolerance(p, noise, tolerance, 400.0);
    const double moves = std::clamp(rate * near_one(), 0.001, 0.999);
    const auto lines =
        doubts(fmt::format("tolerance: {:.17g}, within: 0.1, moves: {:.17g}", tolerance, moves),
               "bits: 24, range: 50", encoder);
    EXPECT_EQ(is_told(lines, "rms moves the axis by"), moves > rate) << tolerance << " " << moves;
  }
}

// No trial does better than told, whatever the law: of an air bearing too, which has no loop at rest.
TEST_F(GoalPlausibility, MovesMeetAToleranceNoOftenerThanTold) {
  constexpr int trials = 60;
  for (const double tolerance : {1.0e-11, 2.0e-8, 2.5e-8, 3.0e-8}) {
    const study::Study study = manifest::parse_study(
        fmt::format(
            "zerocount: 1\nname: air\naxis: linear\nseed: 5\ntrials: {}\n"
            "plant: {{inertia: 1, presliding_damping: 5}}\nfriction: {{model: none}}\n"
            "encoder: {{resolution: 1.0e-9, fine_errors: {{noise: 40}}}}\n"
            "dac: {{bits: 24, resolution: 1.0e-6}}\n"
            "controller: {{units: si, sample_rate: 10000, delay: 1, kp: 4.0e+4, ki: 2.0e+6, kd: 300}}\n"
            "command: {{targets: [1000], hold: 1}}\n"
            "goal: {{tolerance: {:.17g}, within: 0.5, moves: 0.99}}\n",
            trials, tolerance),
        "m.yaml", {});
    const trial::TrialParameters p = study::study_trial(study, 0, 0).parameters;
    const NoiseResponse response = response_to_noise(trial_loops(p).front().loop, NoiseAt::axis,
                                                     std::numeric_limits<double>::infinity());
    const double inside = std::erf(tolerance / (40e-9 * response.gain) / std::numbers::sqrt2);
    const double bound = std::pow(inside, 5000.0 / response.correlated_samples);
    EXPECT_EQ(is_told(doubtful_goals(study), "rms moves the axis by"), bound < 0.99);
    int met = 0;
    for (int i = 0; i < trials; ++i) {
      const trial::TrialOutcome outcome = trial::run_trial(study::study_trial(study, 0, i).parameters);
      met += outcome.moves[0].tolerance_settling_times[0] <= 0.5 ? 1 : 0;
    }
    EXPECT_LE(met, trials * bound + 4.0 * std::sqrt(trials * bound * (1.0 - bound))) << tolerance;
  }
}

// A target in SI units may lie half a count beside the middle of its count.
TEST_F(GoalPlausibility, ZeroCountsHoldACountWhereTargetsAreRounded) {
  const auto told = [](const std::string& target, const std::string& goal) {
    return doubtful_goals(manifest::parse_study(
        fmt::format(
            "zerocount: 1\nname: si\naxis: linear\nseed: 1\ntrials: 20\n"
            "plant: {{inertia: 5, presliding_damping: 1500, sliding_damping: 50}}\n"
            "friction: {{k1: 1.0e+6, k2: 2.0e+7, beta: 2.0e+6, alpha: 0, breakaway: 12, coulomb_ratio: "
            "0.8, stribeck_velocity: 1.0e-3}}\n"
            "encoder: {{resolution: 1.0e-8}}\ndac: {{bits: 20, resolution: 5.0e-5}}\n"
            "controller: {{units: si, sample_rate: 10000, kp: 2.0e+6, ki: 5.0e+8}}\n"
            "command: {{units: si, targets: [{}], hold: 0.5}}\ngoal: {{within: 0.4, {}}}\n",
            target, goal),
        "m.yaml", {}));
  };
  const std::string drawn = "{uniform: [5.0e-7, 2.0e-6]}";
  const auto lines = told(drawn, "tolerance: 4.0e-9, moves: 0.9");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("expected at least 1e-08 m, which zero counts hold"), std::string::npos)
      << lines[0];
  // At 0.5 counts 75 % of the moves at zero counts are within it, at 0.9 counts 99 %.
  EXPECT_TRUE(is_told(told(drawn, "tolerance: 5.0e-9, moves: 0.9"), "which zero counts hold"));
  EXPECT_FALSE(is_told(told(drawn, "tolerance: 5.0e-9, moves: 0.7"), "which zero counts hold"));
  EXPECT_FALSE(is_told(told(drawn, "tolerance: 9.0e-9, moves: 0.98"), "which zero counts hold"));
  EXPECT_FALSE(is_told(told("1.23e-6", "tolerance: 5.0e-9, moves: 0.9"), "which zero counts hold"));
  EXPECT_TRUE(is_told(told("1.234e-6", "tolerance: 5.0e-9, moves: 0.9"), "which zero counts hold"));
}

TEST_F(GoalPlausibility, TheGoalAndItsConditionAreNamed) {
  const study::Study study = study_asking(
      "goals: {coarse: {band: 2, within: 0.1, moves: 0.5}, fine: {tolerance: 1.0e-8, within: 0.1, moves: "
      "0.5}}\n"
      "conditions: {cold: {dac.resolution: 1.0e-5}, warm: {dac.resolution: 0.15}}",
      "dac: {bits: 20, resolution: 1.0e-5}\n");
  const auto lines = doubtful_goals(study);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines.front().starts_with("point 0 (all) under condition warm: goal fine: one code of the DAC"))
      << lines.front();
  EXPECT_TRUE(doubtful_goals(study_asking("", "dac: {bits: 20, range: 50}\n")).empty());
}

}  // namespace
}  // namespace zerocount::theory
