// `limits` with effects added: what each effect is, and that its rate is that of the manifest which states
// it.
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "runners/tuning/effects/effects.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using tuning::EffectRuns;
using tuning::Limit;

study::Study parsed(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return manifest::parse_study(text, "axis.yaml", overrides);
}

EffectRuns runs_of(const study::Study& study) {
  return {study, trials::replicates_of(study, 0), {}};
}

/// Success rates in a run of a study with this manifest and these overrides, as a row of the command
/// `limits`.
Limit stated(const std::string& text, const std::vector<std::string>& overrides) {
  const study::Study study = parsed(text, overrides);
  const EffectRuns runs = runs_of(study);
  return limit_of(runs, runs.base());
}

void expect_same(const Limit& found, const Limit& wanted) {
  ASSERT_TRUE(found.rate.has_value()) << found.note;
  EXPECT_EQ(found.estimate.rates, wanted.estimate.rates) << found.effect;
  EXPECT_EQ(found.rate, wanted.rate) << found.effect;
  EXPECT_EQ(found.worst.goal, wanted.worst.goal) << found.effect;
  EXPECT_EQ(found.worst.setting, wanted.worst.setting) << found.effect;
  EXPECT_EQ(found.rates, wanted.rates) << found.effect;
}

/// Overrides that put half of an inertia (kg m^2) behind a coupling with a natural frequency (Hz) and 1 % of
/// critical damping.
std::vector<std::string> mode_of(double inertia, double frequency, const std::string& condition = "") {
  const double omega = 2.0 * std::numbers::pi * frequency;
  const double reduced = inertia / 4.0;
  const std::string path = condition.empty() ? "" : "conditions." + condition + ".";
  return {fmt::format("{}plant.inertia={}", path, inertia / 2.0),
          fmt::format("{}plant.load.inertia={}", path, inertia / 2.0),
          fmt::format("{}plant.load.stiffness={}", path, reduced * omega * omega),
          fmt::format("{}plant.load.damping={}", path, 2.0 * 0.01 * reduced * omega)};
}

/// The frequency that the text of a row names, Hz.
double frequency_in(const std::string& text) {
  return std::stod(text.substr(text.find_first_of("0123456789")));
}

constexpr const char* of_trials = R"(zerocount: 1
name: of-trials
seed: 5
trials: 60
plant: {inertia: 8.0e-4}
friction: {k1: {lognormal: {median: 130, cv: 0.2}}}
encoder: {fine: 400000, fine_errors: {noise: 0.3}}
controller: {ki: 6.0e-5, kp: 1.0e-4, kd: 3.0e-3, delay: {uniform: [0, 2]}}
command: {targets: [{integers: [3, 8]}, -2], hold: 0.1}
initial: {encoder_phase: {uniform: [0, 1]}}
goal: {band: 2, within: 0.04, moves: 0.9}
)";

constexpr const char* of_a_stage = R"(zerocount: 1
name: of-a-stage
axis: linear
seed: 1
trials: 24
plant: {inertia: 3.2, presliding_damping: {log_uniform: [310, 930]}, sliding_damping: 15}
friction: {k1: {log_uniform: [1.25e+4, 1.125e+5]}, k2: 4.7e+6, beta: 8.0e+5, breakaway: 4, coulomb_ratio: 0.9, stribeck_velocity: 1.0e-3, alpha: 0}
encoder: {resolution: 5.0e-9}
dac: {bits: 16, range: 60}
controller: {units: si, sample_rate: 8000, delay: 1, kp: 2.276e+6, ki: 1.424e+9, kd: 4346}
command: {units: si, targets: [1.0e-6, 0], hold: 0.05}
initial: {encoder_phase: {uniform: [0, 1]}}
goal: {band: 2, within: 0.03, moves: 0.9}
)";

constexpr const char* of_claims = R"(zerocount: 1
name: of-claims
seed: 7
machines: 20
trials: 80
plant: {inertia: 5.54e-4}
friction: {k1: {lognormal: {median: 130, cv: 0.2}, per: machine}}
controller: {ki: 3.0e-5, delay: 1}
command: {targets: [29, 0, 5], hold: 0.1}
initial: {encoder_phase: {uniform: [0, 1]}}
conditions:
  empty: {}
  loaded: {plant.inertia: 8.0e-4, controller.delay: {uniform: [1, 1.5]}}
goals:
  large: {"on": [0, 1], band: 1, within: 0.03, moves: 0.9, machines: 0.8}
  small: {"on": [2], band: 1, within: 0.03, moves: 0.8, limits: {overshoot: 10}}
)";

constexpr const char* of_two_encoders = R"(zerocount: 1
name: of-two-encoders
axis: linear
seed: 6
trials: 30
plant: {inertia: 3, presliding_damping: 400, sliding_damping: 20}
friction: {k1: 3.0e+4, k2: {uniform: [1.0e+6, 3.0e+6]}, beta: 4.0e+5, breakaway: 4, stribeck_velocity: 1.0e-3, alpha: 0}
encoder: {resolution: 2.0e-8, coarse_resolution: 1.0e-7, fine_errors: {noise: 0.3}, coarse_errors: {noise: 0.2}}
dac: {bits: 12, range: 60}
controller:
  units: si
  sample_rate: 4000
  ki: 8.0e+7
  coarse: {kp: 1.0e+6, ki: 5.0e+7, kd: 3000, encoder: coarse, coarse_beyond: 60, fine_within: 30, fine_rate: 2}
command: {units: si, targets: [5.0e-6, 0], hold: 0.2}
initial: {encoder_phase: {uniform: [0, 1]}}
goal: {band: 3, within: 0.1, moves: 0.9}
)";

std::string hypot_text(double a, double b) {
  return fmt::format("{}", std::hypot(a, b));
}

TEST(Additions, RatesEqualRunsOfTheirManifests) {
  struct Case {
    const char* text;
    std::vector<std::string> with_noise, with_delay;
  };
  const std::vector<Case> cases{
      {of_trials,
       {"encoder.fine_errors.noise=" + hypot_text(0.3, 0.1)},
       {"controller.delay={uniform: [1, 3]}"}},
      {of_claims,
       {"encoder.fine_errors.noise=0.1"},
       {"controller.delay=2", "conditions.loaded.controller.delay={uniform: [2, 2.5]}"}},
      {of_two_encoders,
       {"encoder.fine_errors.noise=" + hypot_text(0.3, 0.1),
        "encoder.coarse_errors.noise=" + hypot_text(0.2, 0.1)},
       {"controller.delay=1"}},
  };
  bool differ = false;
  bool differ_by_delay = false;
  for (const Case& one : cases) {
    const study::Study study = parsed(one.text);
    SCOPED_TRACE(study.name);
    const EffectRuns runs = runs_of(study);
    const std::vector<Limit> rows = additions_to(runs);
    ASSERT_EQ(rows.size(), 3U);
    expect_same(rows[0], stated(one.text, one.with_noise));
    expect_same(rows[1], stated(one.text, one.with_delay));
    differ_by_delay = differ_by_delay || rows[1].estimate.rates != limit_of(runs, runs.base()).estimate.rates;
    differ = differ || rows[0].estimate.rates != limit_of(runs, runs.base()).estimate.rates;
  }
  EXPECT_TRUE(differ && differ_by_delay) << "these studies show no effect";
}

TEST(Additions, PutNoiseOnTheEncoderThatClosesTheLoop) {
  const std::vector<std::string> coarse{"controller.coarse={}", "controller.encoder=coarse", "goal.band=20"};
  const study::Study study = parsed(of_two_encoders, coarse);
  std::vector<std::string> noisy = coarse;
  noisy.push_back("encoder.coarse_errors.noise=" + hypot_text(0.2, 0.1));
  expect_same(additions_to(runs_of(study)).front(), stated(of_two_encoders, noisy));
  trial::TrialParameters p = study::study_trial(study, 0, 0).parameters;
  tuning::added_effects(study, 0).front().change(p);
  EXPECT_EQ(p.encoder.fine_errors.noise, 0.3);
  EXPECT_DOUBLE_EQ(p.encoder.coarse_errors.noise, std::hypot(0.2, 0.1));
}

TEST(Additions, ResonanceIsThatOfTwoFreeMasses) {
  const study::Study study = parsed(of_trials);
  for (const double frequency : {20.0, 333.0, 5000.0}) {
    trial::TrialParameters p = study::study_trial(study, 0, 0).parameters;
    const double inertia = p.plant.inertia;
    tuning::load_mode(study, 0, frequency).change(p);
    EXPECT_DOUBLE_EQ(p.plant.inertia + p.plant.load.inertia, inertia);
    const double inverse = 1.0 / p.plant.inertia + 1.0 / p.plant.load.inertia;
    const double omega = std::sqrt(p.plant.load.stiffness * inverse);
    EXPECT_NEAR(omega / (2.0 * std::numbers::pi * frequency), 1.0, 1e-12);
    EXPECT_NEAR(p.plant.load.damping * inverse / (2.0 * omega), 0.01, 1e-14);
  }
}

// The row's rate is that of the manifest with the mode, which costs no claim more than 1 %; the frequency
// that is said to cost more does.
TEST(Additions, FindTheLowestTolerableResonance) {
  struct Case {
    std::string text;
    std::vector<std::pair<double, std::string>> inertias;  // and conditions
  };
  const std::string two_loads =
      std::string(of_a_stage) + "conditions: {empty: {}, loaded: {plant.inertia: 4.6}}\n";
  const std::vector<Case> cases{{of_a_stage, {{3.2, ""}}}, {two_loads, {{3.2, ""}, {4.6, "loaded"}}}};
  for (const Case& one : cases) {
    const study::Study study = parsed(one.text);
    SCOPED_TRACE(study.name);
    const EffectRuns runs = runs_of(study);
    const std::vector<double> without = limit_of(runs, runs.base()).estimate.rates;
    const Limit row = additions_to(runs).back();
    const auto with_mode = [&](double frequency) {
      std::vector<std::string> overrides;
      for (const auto& [inertia, condition] : one.inertias) {
        for (const std::string& text : mode_of(inertia, frequency, condition)) overrides.push_back(text);
      }
      return stated(one.text, overrides);
    };
    const auto largest_loss = [&](const Limit& limit) {
      double loss = 0.0;
      for (std::size_t claim = 0; claim < without.size(); ++claim)
        loss = std::max(loss, without[claim] - limit.estimate.rates[claim]);
      return loss;
    };
    const Limit wanted = with_mode(frequency_in(row.effect));
    expect_same(row, wanted);
    EXPECT_LE(largest_loss(wanted), 0.01 + 1e-9) << row.effect;
    ASSERT_NE(row.note.find(" Hz costs more than 1 %"), std::string::npos) << row.note;
    const double missed = frequency_in(row.note);
    EXPECT_LT(missed, frequency_in(row.effect));
    EXPECT_GT(missed, frequency_in(row.effect) / 1.06) << "bisected to 5 %, in three digits";
    EXPECT_GT(largest_loss(with_mode(missed)), 0.01 + 1e-9) << row.note;
  }
}

// A mode takes long: of a large study its rate is of the first machines, and says so.
TEST(Additions, LargeStudiesTryResonancesOnTheirFirstMachines) {
  const std::string larger = "trials=6000";
  const study::Study study = parsed(of_trials, {larger, "command.hold=0.06"});
  const EffectRuns runs = runs_of(study);
  const Limit row = additions_to(runs).back();
  EXPECT_LT(row.estimate.machines, 6000);
  EXPECT_NEAR(static_cast<double>(row.estimate.machines) * 240, 8.0e5, 240);
  EXPECT_TRUE(says(row.note, fmt::format("first {} of 6000 draws", row.estimate.machines)));
}

TEST(Additions, CasesThatAreNotSimulatedGiveTheReason) {
  const study::Study late = parsed(of_trials, {"controller.delay=100"});
  const std::vector<Limit> rows = additions_to(runs_of(late));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_FALSE(rows[1].rate);
  EXPECT_TRUE(says(rows[1].note, "controller.delay: it would be 101"));
  const study::Study loaded = parsed(of_trials, {"plant.load.inertia=1.0e-4"});
  EXPECT_EQ(additions_to(runs_of(loaded)).size(), 2U) << "it has a mode of its own";
}

// Premises of an answer: the rates with others are those of the manifests that state them.

constexpr const char* text = R"(zerocount: 1
name: premises
seed: 3
trials: 96
command: {targets: [29, 0], hold: 0.25}
controller: {ki: 3.0e-5, delay: 1}
friction: {k1: {lognormal: {median: 120, cv: 0.3}}, alpha: {uniform: [0.2, 0.6]}}
encoder: {fine_errors: {noise: 0.05}}
initial: {encoder_phase: {uniform: [0, 1]}}
conditions: {light: {}, heavy: {plant.inertia: 7.0e-4}}
goal: {band: 1, within: 0.1, moves: 0.6}
)";

study::Study stated(std::vector<std::string> overrides = {}) {
  return manifest::parse_study(text, "axis.yaml", overrides);
}

double rate_of(const study::Study& study) {
  const EffectRuns runs(study, trials::replicates_of(study, 0), {});
  return *limit_of(runs, runs.base()).rate;
}

std::vector<Limit> variations() {
  const study::Study study = stated();
  const trials::Replicates machines = trials::replicates_of(study, 0);
  return variations_of(EffectRuns(study, machines, {}), machines,
                       [](std::uint64_t seed) { return stated({fmt::format("seed={}", seed)}); });
}

TEST(Robustness, RatesEqualRunsOfManifestsWithOtherAssumptions) {
  const std::vector<Limit> found = variations();
  ASSERT_EQ(found.size(), 4U);
  double lowest = 1.0;
  for (int i = 0; i < 10; ++i) {
    const std::uint64_t seed = trials::fresh_seed(3, fmt::format("other seed {}", i));
    lowest = std::min(lowest, rate_of(stated({fmt::format("seed={}", seed)})));
  }
  EXPECT_EQ(found[0].rate, lowest);
  const double cv =
      std::sqrt(std::pow(1.0 + 0.3 * 0.3, 4.0) - 1.0);  // twice the standard deviation of the logarithm
  EXPECT_NEAR(*found[1].rate,
              rate_of(stated(
                  {fmt::format("friction.k1.lognormal.cv={:.17g}", cv), "friction.alpha.uniform=[0,0.8]"})),
              0.011);
  EXPECT_EQ(found[2].rate, rate_of(stated({"controller.delay=0.5"})));
  EXPECT_EQ(found[3].rate, rate_of(stated({"controller.delay=2"})));
  for (const Limit& one : found) EXPECT_EQ(one.holds, *one.rate >= 0.6) << one.effect;
  EXPECT_NE(found[2].rate, found[3].rate) << "the delay must matter here";
}

// A value that would leave its range stays, and the row says so.
TEST(Robustness, NamesParametersThatCannotBeVaried) {
  const auto effects = tuning::other_premises(
      manifest::parse_study(std::string(text) + "plant: {presliding_damping: {uniform: [0.01, 0.3]}}\n",
                            "axis.yaml", {}),
      0);
  EXPECT_TRUE(says(effects.front().note, "plant.presliding_damping"));
}

}  // namespace
}  // namespace zerocount::testing
