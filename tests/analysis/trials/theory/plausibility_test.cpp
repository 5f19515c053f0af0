// Goals that no loop can meet are told, with the bound that keeps them from it.
#include "analysis/trials/theory/plausibility.hpp"

#include "analysis/trials/theory/theory_prediction.hpp"
#include "analysis/trials/theory/trial_loops.hpp"
#include "core/theory/margins.hpp"
#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/test.hpp"

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
  /// A random factor just above or just below 1, with which a value lies just inside or outside of a limit.
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
    EXPECT_TRUE(says(told.front(), fmt::format("expected at least {:.3g} m", 0.5 * resolution)));
  }
}

// (1 - 2 Q((b + 1/2)/noise))^n, n the samples from `within` on.
TEST_F(GoalPlausibility, ABandIsWiderThanTheNoiseAtStandstill) {
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
    EXPECT_TRUE(says(lines.front(), fmt::format("at most {:.3g} % of the moves", 100.0 * rate)));
  }
  EXPECT_GT(told, rounds / 5);
  EXPECT_LT(told, rounds * 4 / 5);
}

// The bound is one: no trial of a loop, stable and ideal but for its noise, does better by more than chance.
TEST_F(GoalPlausibility, NoMoreMovesMeetABandThanPredicted) {
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
    const double bound = std::pow(std::erf(0.5 / noise / std::numbers::sqrt2), 200.0);
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
      EXPECT_TRUE(says(lines.front(), fmt::format("a code of at most {:.3g} N", 5e6 * width)));
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

/// The highest proportion of moves whose position error stays within the tolerance for the last `samples`
/// samples, over the loops of the contact at rest.
/// @param noise standard deviation of the encoder noise, counts
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

TEST_F(GoalPlausibility, AToleranceIsWiderThanTheMotionByNoise) {
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
TEST_F(GoalPlausibility, NoMoreMovesMeetAToleranceThanPredicted) {
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
TEST_F(GoalPlausibility, ZeroCountsIncludeACountIfTargetsAreRounded) {
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
  EXPECT_TRUE(says(lines[0], "expected at least 1e-08 m, which zero counts hold"));
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

// Moves that are said to be out of reach are: no trial of a random loop makes one.

/// A study of a slide of 1 kg with a fast PID; `rest` gives the other sections of the manifest.
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
  return is_told(doubtful_goals(study), what);
}

/// Whether the last move of a trial is within the goal's tolerance for good in the allowed time.
bool meets(const study::Study& study, std::int64_t trial = 0) {
  const trial::TrialOutcome outcome = trial::run_trial(study::study_trial(study, 0, trial).parameters);
  const trial::MoveOutcome& last = outcome.moves.back();
  return last.tolerance_settling_times[0] <= study.goals.front().within.from_start(last.travel_time);
}

constexpr std::array<const char*, 7> words_of_laws{"none", "coulomb", "presliding", "spring",
                                                   "dahl", "lugre",   "gms"};

TEST(MovePlausibility, NoTrialMakesAMoveThatNeedsMoreTorque) {
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
  const auto told = [](const std::string& plant, double range, double within, bool by_amplifier = false) {
    const std::string drive =
        by_amplifier ? fmt::format("dac: {{bits: 24, range: 100}}\namplifier: {{limit: {:.6g}}}", range)
                     : fmt::format("dac: {{bits: 24, range: {:.6g}}}", range);
    study::Study study = manifest::parse_study(
        fmt::format(
            "zerocount: 1\nname: s\naxis: linear\nseed: 1\ntrials: 2\nplant: {{presliding_damping: 0, "
            "{}}}\nfriction: {{model: none}}\nencoder: {{resolution: 1.0e-7}}\n"
            "{}\ncontroller: {{units: si, delay: 0, kp: 100, ki: 0}}\n"
            "command: {{units: si, targets: [0.025], hold: 1}}\n"
            "goal: {{tolerance: 1.0e-6, within: {:.6g}, moves: 0.9}}\n",
            plant, drive, within),
        "m.yaml", {});
    return is_told(study, " s at least");
  };
  EXPECT_TRUE(told("inertia: 1", 10.0, 0.099));
  EXPECT_FALSE(told("inertia: 1", 10.0, 0.101));
  EXPECT_FALSE(told("inertia: 1", 10.3, 0.099));
  EXPECT_TRUE(told("inertia: 1", 10.0, 0.099, true));
  EXPECT_FALSE(told("inertia: 1", 10.0, 0.101, true));
  EXPECT_TRUE(told("inertia: 0.7, load: {inertia: 0.3, stiffness: 1.0e+5, damping: 5}", 10.0, 0.099));
  EXPECT_FALSE(told("inertia: 0.7, load: {inertia: 0.3, stiffness: 1.0e+5, damping: 5}", 10.0, 0.101));
}

TEST(MovePlausibility, ADisturbanceAboveTheRangeIsReportedWithAndWithoutAGoal) {
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

// The torque is named by what bounds it.
TEST(MovePlausibility, TheTorqueLimitIsNamedByWhatBoundsIt) {
  const auto told = [](const std::string& drive, const std::string& disturbance) {
    return fmt::format(
        "{}", fmt::join(doubtful_goals(slide(drive + "disturbance: {torque: " + disturbance +
                                                 "}\ncommand: {targets: [100000], hold: 0.2}\n"
                                                 "goal: {tolerance: 1.0e-6, within: 0.1, moves: 0.9}\n",
                                             "coulomb", 0.1)),
                        "\n"));
  };
  const std::string by_converter = "dac: {bits: 20, range: 2}\n";
  const std::string by_limit = "dac: {bits: 20, range: 200}\namplifier: {limit: 2}\n";
  for (const char* const disturbance : {"0", "3"}) {
    EXPECT_TRUE(says(told(by_converter, disturbance), "±2 N of the converter"));
    EXPECT_TRUE(says(told(by_converter, disturbance), "expected a larger range of the converter"));
    EXPECT_FALSE(says(told(by_converter, disturbance), "amplifier.limit"));
    EXPECT_TRUE(says(told(by_limit, disturbance), "±2 N of the torque limit (amplifier.limit)"));
    EXPECT_TRUE(says(told(by_limit, disturbance), "expected a larger amplifier.limit"));
    EXPECT_FALSE(says(told(by_limit, disturbance), "converter"));
  }
  // A limit beyond the converter's range bounds nothing.
  EXPECT_TRUE(says(told(by_converter + "amplifier: {limit: 3}\n", "0"), "of the converter"));
}

/// A cause that keeps the load of a cascade from its goal, and the warning that names it.
struct CauseOfMisses {
  const char* told;
  std::string load;     ///< manifest keys of plant.load; {} stands for the size of the cause
  std::string cascade;  ///< manifest keys of controller.cascade; {} stands for the size of the cause
  /// Size of the cause at the limit: the load ends 1e-4 rad (the tolerance) from the target, or the move
  /// takes as long as the goal allows.
  double size_at_limit;
};

study::Study cascade_with_load(const CauseOfMisses& cause, double size, const std::string& target,
                               const std::string& encoder = "motor") {
  return manifest::parse_study(
      fmt::format(
          "zerocount: 1\nname: reach\nseed: 1\ntrials: 1\n"
          "plant: {{inertia: 1.0e-4, presliding_damping: 1.0e-3, load: {{inertia: 1.0e-4, stiffness: "
          "400, damping: 5.0e-3, encoder: {}{}}}}}\nfriction: {{model: none}}\n"
          "encoder: {{fine: 1000000}}\ndac: {{bits: 18, range: 4}}\n"
          "controller: {{sample_rate: 8000, delay: 1, structure: cascade, cascade: {{kv: 40, kp: 0.03, "
          "ki: 0.3{}}}}}\ncommand: {{units: si, targets: [{}], hold: 0.6}}\n"
          "goal: {{of: load, tolerance: 1.0e-4, within: 0.35, moves: 0.8}}\n",
          encoder, fmt::format(fmt::runtime(cause.load), size),
          fmt::format(fmt::runtime(cause.cascade), size), target),
      "m.yaml", {});
}

bool load_meets(const study::Study& study) {
  const trial::TrialOutcome outcome = trial::run_trial(study::study_trial(study, 0, 0).parameters);
  const trial::MoveOutcome& move = outcome.moves.back();
  return (study.goals.front().of_other_mass ? move.other_tolerance_settling_times
                                            : move.tolerance_settling_times)[0] <= 0.35;
}

// Against runs, both ways: what is told is of no move that meets the goal; and a cause that makes a move
// miss, well beyond its limit, is told.
TEST(MovePlausibility, CausesThatKeepALoadFromItsGoalAreReportedIfTheMoveMisses) {
  const CauseOfMisses causes[] = {
      {"half of the gap", ", gap: {0:.6g}, friction: {{model: coulomb, breakaway: 1.0e-3}}", "", 2e-4},
      {"kinematic error", ", error: [{{amplitude: {0:.6g}, periods: 100, phase: 1}}]", "",
       1e-4 / std::abs(std::sin(6.0))},
      {"wind up the coupling", ", friction: {{model: coulomb, breakaway: {0:.6g}}}", "", 400 * 1e-4},
      {"wind up the coupling", ", friction: {{model: dahl, breakaway: {0:.6g}, sigma0: 3.0e+3}}", "",
       500 * 1e-4},
      {"has steps of", "", ", resolution: {0:.6g}", 80 * 1e-4},
      {"of the velocity command", "", ", limit: {0:.6g}", -0.05 / 0.35}};
  testing::RandomBlocks draw(41);
  for (const CauseOfMisses& cause : causes) {
    int told = 0;
    int met = 0;
    for (int i = 0; i < 24; ++i) {
      // A negative limit: the cause is a value that is too small.
      const double excess = draw.log_uniform(0.02, 20.0);
      const double size =
          cause.size_at_limit > 0.0 ? excess * cause.size_at_limit : -cause.size_at_limit / excess;
      const study::Study study = cascade_with_load(cause, size, "0.05");
      const bool is_met = load_meets(study);
      const bool said = is_told(study, cause.told);
      EXPECT_FALSE(said && is_met) << cause.told << " " << size;
      if (excess > 2.0) {
        EXPECT_EQ(said, !is_met) << cause.told << " " << size;
      }
      if (excess < 0.9) {
        EXPECT_FALSE(said) << cause.told << " " << size;
      }
      told += said ? 1 : 0;
      met += is_met ? 1 : 0;
    }
    EXPECT_GT(told, 3) << cause.told;
    EXPECT_GT(met, 3) << cause.told;
  }
}

TEST(MovePlausibility, AnEncoderAtTheLoadNeedsNoWarningOfKinematicError) {
  const CauseOfMisses error{"kinematic error", ", error: [{{amplitude: {0:.6g}, periods: 20, phase: 1}}]", "",
                            0.0};
  EXPECT_TRUE(is_told(cascade_with_load(error, 1e-3, "0.05"), error.told));
  EXPECT_FALSE(is_told(cascade_with_load(error, 1e-3, "0.05", "load"), error.told));
}

// A load with a constant torque on it is doubted exactly where its simulated move misses.
TEST(MovePlausibility, ALoadBehindTheEncoderWindsUpTheCoupling) {
  for (const double torque : {0.5, 2.0, 4.0})
    for (const double stiffness : {1.0e+4, 4.0e+4}) {
      const auto with = [&](const std::string& encoder, const std::string& friction) {
        return manifest::parse_study(
            fmt::format(
                "zerocount: 1\nname: load\nseed: 1\ntrials: 2\n"
                "plant: {{inertia: 0.5, sliding_damping: 3, load: {{inertia: 0.3, stiffness: {}, damping: "
                "20, encoder: {}{}}}}}\n"
                "friction: {{model: dahl, sigma0: 3.0e+4, breakaway: 2}}\n"
                "encoder: {{fine: 2000000}}\ndac: {{bits: 20, range: 100}}\n"
                "controller: {{units: si, sample_rate: 4000, kp: 3000, ki: 3.0e+4, kd: 60}}\n"
                "disturbance: {{load: {{torque: {}}}}}\n"
                "command: {{units: si, targets: [0.01], hold: 2}}\n"
                "goal: {{of: load, tolerance: 1.0e-4, within: 1.5, moves: 0.9}}\n",
                stiffness, encoder, friction, torque),
            "m.yaml", {});
      };
      const study::Study study = with("motor", "");
      const trial::MoveOutcome move =
          trial::run_trial(study::study_trial(study, 0, 0).parameters).moves.front();
      const bool misses = !(move.other_tolerance_settling_times[0] <= 1.5);
      EXPECT_EQ(misses, torque / stiffness > 1e-4) << torque << " " << stiffness;
      EXPECT_EQ(is_told(study, "wind up the coupling"), misses) << torque << " " << stiffness;
      EXPECT_FALSE(is_told(with("load", ""), "wind up the coupling"));
      const study::Study rubs = with("motor", ", friction: {model: dahl, breakaway: 5, sigma0: 1.0e+4}");
      const trial::MoveOutcome of_load =
          trial::run_trial(study::study_trial(rubs, 0, 0).parameters).moves.front();
      EXPECT_EQ(is_told(rubs, "wind up the coupling"), !(of_load.other_tolerance_settling_times[0] <= 1.5))
          << torque << " " << stiffness;
    }
}

TEST(MovePlausibility, AGoalMustLeaveTimeForTheProfile) {
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

TEST(MovePlausibility, TheHoldLastsUntilTheTimeAfterTheProfile) {
  testing::RandomBlocks draw(13);
  for (int i = 0; i < 40; ++i) {
    const double after = draw.uniform(0.05, 0.4);
    const double travel = 0.03 / 0.2 + 0.2 / 5.0;  // s, of the longer move
    EXPECT_EQ(
        is_told(
            slide(fmt::format("dac: {{bits: 24, range: 500}}\n"
                              "command: {{units: si, targets: [0.02, 0.05], hold: 0.45, profile: {{shape: "
                              "trapezoidal, velocity_limit: 0.2, acceleration_limit: 5}}}}\n"
                              "goal: {{tolerance: 2.0e-5, after_profile: {:.6g}, moves: 0.9, \"on\": [1]}}\n",
                              after),
                  "lugre", 5.0),
            "more than its hold of 0.45 s"),
        travel + after > 0.45)
        << after;
  }
}

TEST(MovePlausibility, ABandMustBeLessThanHalfAStep) {
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

// Loops that nobody would build on purpose are told at the worst point, with the margins of trial_loops().

study::Study study_with(const std::string& target, const std::string& controller,
                        const std::string& more = "") {
  return manifest::parse_study(
      fmt::format("zerocount: 1\nname: doubt\nseed: 1\ntrials: 2\ncommand: {{targets: "
                  "[{}]}}\ncontroller: {{{}}}\n{}",
                  target, controller, more),
      "m.yaml", {});
}

/// The smallest phase margin at rest over the stable loops of the study, °; NaN if a loop is unstable or has
/// no phase margin.
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
    EXPECT_EQ(is_told(lines, "phase margin is"), margin < 20.0) << margin;
    if (margin < 20.0) {
      EXPECT_TRUE(is_told(lines, "point 0 (all): at k1")) << lines.front();
    }
    ++(margin < 20.0 ? doubtful : sound);
  }
  EXPECT_GT(doubtful, 5);
  EXPECT_GT(sound, 5);
}

TEST(LoopPlausibility, TheWorstPointIsReported) {
  const study::Study study =
      study_with("5", "kp: 6.21e-4", "sweep: {grid: {controller.ki: [2.0e-5, 9.45e-5, 3.0e-4, 5.0e-5]}}\n");
  const std::vector<std::string> lines = doubtful_loops(study);
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines.front().starts_with("point 2 (controller.ki=0.0003): at k1 the phase margin is -"))
      << lines.front();
  EXPECT_TRUE(is_told(lines, "the loop is unstable"));
}

// The paper's: between criteria (6) and (7) some histories are stable; beyond (7) none.
TEST(LoopPlausibility, PureIntegralControlBeyondCriterion7GetsAWarning) {
  for (const double ki : {1e-5, 3.85e-5, 9.45e-5, 2.08e-4})
    EXPECT_TRUE(doubtful_loops(study_with("30", fmt::format("ki: {}", ki))).empty()) << ki;
  EXPECT_TRUE(is_told(doubtful_loops(study_with("30", "ki: 4.0e-4")), "at k1 + k2 the phase margin"));
}

// The pre-sliding range is 694 counts: the loop with integral control alone is unstable while it slides.
TEST(LoopPlausibility, AMoveBeyondThePreslidingRangeNeedsALoopThatIsStableWhileItSlides) {
  const char* const text = "longer than the pre-sliding range of 694.4 counts";
  for (const char* const shape : {"step", "trapezoidal", "s_curve"}) {
    const auto told = [shape](const std::string& targets, const std::string& controller,
                              const std::string& what) {
      return is_told(
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

TEST(LoopPlausibility, TheLoopMustStayStableWithOneMoreSampleOfDelay) {
  // Far above the resonance the crossover is so fast that one sample costs more than the margin.
  const study::Study study = study_with("5", "kd: 1.28e-2, ki: 3.85e-5");
  const std::vector<std::string> lines = doubtful_loops(study);
  EXPECT_TRUE(is_told(lines, "samples more makes the loop unstable")) << lines.size();
}

// In its gap the motor moves without its load, by a loop that the gains for both masses make unstable.
TEST(LoopPlausibility, AnUnstableLoopOfTheMotorInsideTheGapIsReported) {
  const auto told = [](const std::string& gap) {
    return fmt::format(
        "{}",
        fmt::join(
            doubtful_loops(manifest::parse_study(
                fmt::format(
                    "zerocount: 1\nname: gap\nseed: 1\ntrials: 1\ncommand: {{targets: [5000]}}\n"
                    "plant: {{inertia: 2.0e-5, presliding_damping: 1.0e-4, load: {{inertia: 2.0e-4, "
                    "stiffness: 4000, damping: 0.05{}}}}}\nfriction: {{model: none}}\n"
                    "encoder: {{fine: 1000000}}\ncontroller: {{sample_rate: 8000, delay: 1, "
                    "derivative_cutoff: 300, structure: cascade, cascade: {{kv: 40, kp: 0.12, ki: 1}}}}\n",
                    gap),
                "m.yaml", {})),
            "\n"));
  };
  EXPECT_EQ(told(""), "");
  EXPECT_TRUE(
      says(told(", gap: 1.0e-3"), "without friction, the motor alone in the gap the phase margin is -"));
  EXPECT_TRUE(says(told(", gap: 1.0e-3"), "and the loop is unstable"));
}

TEST(LoopPlausibility, AnOpenLoopGetsNoWarning) {
  EXPECT_TRUE(
      doubtful_loops(manifest::parse_study(
                         "zerocount: 1\nname: open\nseed: 1\ntrials: 1\ncommand: {torque: {levels: [0.1]}}\n",
                         "m.yaml", {}))
          .empty());
}

}  // namespace
}  // namespace zerocount::theory
