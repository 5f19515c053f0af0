// `limits`: which causes a study has, and that the rate without one is that of the manifest which says so.

#include "tests/runners/design_commands/tune_fixture.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

constexpr std::string_view noted = "same gains, not tuned again";

class Limits : public ::testing::Test {
 protected:
  Json limits_of(const std::string& manifest, const std::vector<std::string>& more = {}) {
    folder_.write("axis.yaml", manifest);
    std::vector<std::string> words{"limits", "axis.yaml", "--format", "json"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = zerocount_program(words, folder_.path());
    EXPECT_EQ(result.code, 0) << result.err;
    return result.code == 0 ? Json::parse(result.out)["limits"] : Json::array();
  }

  /// Proportion of moves that meet the goal in a run of the manifest with these overrides.
  double rate_with(const std::string& manifest, const std::vector<std::string>& values) {
    folder_.write("changed.yaml", manifest);
    std::vector<std::string> words{"run", "changed.yaml", "-o", "changed.h5", "--force", "--quiet"};
    for (const std::string& value : values) words.insert(words.end(), {"--set", value});
    const ProgramResult run = zerocount_program(words, folder_.path());
    EXPECT_EQ(run.code, 0) << run.err;
    return Json::parse(
        zerocount_program({"judge", "changed.h5", "--format", "json"}, folder_.path()).out)["rate"];
  }

  static Json row(const Json& limits, const std::string& cause) {
    for (const Json& one : limits) {
      if (one["cause"] == cause) return one;
    }
    return {};
  }

  TemporaryFolder folder_;
};

constexpr std::string_view in_counts = R"(zerocount: 1
name: in-counts
seed: 5
trials: 60
friction: {k1: {lognormal: {median: 130, cv: 0.2}}}
encoder: {fine: 400000, fine_errors: {noise: 0.3, interpolation: 0.5}}
dac: {nonlinearity: 0.6, noise: 1.0e-4}
command: {targets: [{integers: [3, 8]}, -2], hold: 0.2}
initial: {encoder_phase: {uniform: [0, 1]}}
verdict: {dwell: 0.02, window: 0.02}
controller:
  ki: {log_uniform: [5.0e-5, 3.0e-4]}
  kp: 1.0e-4
  kd: 3.0e-3
  integrator_zone: 40
  delay: {uniform: [0, 2]}
  standstill: {band: 2, dwell: 0.01, kp: 2.0e-4, ki: 5.0e-5, kd: 2.0e-3}
  filters: [{lowpass: {frequency: 600, damping: 0.7}}]
goal: {band: 1, within: 0.08, moves: 0.9}
)";

constexpr std::string_view of_two_phases = R"(zerocount: 1
name: of-two-phases
axis: linear
seed: 6
trials: 40
plant: {inertia: 3, presliding_damping: 400, sliding_damping: 20}
friction: {k1: 3.0e+4, k2: {uniform: [1.0e+6, 3.0e+6]}, beta: 4.0e+5, breakaway: 4, stribeck_velocity: 1.0e-3, alpha: 0}
encoder: {resolution: 2.0e-8, coarse_resolution: 1.0e-7, fine_errors: {noise: 0.3}, coarse_errors: {noise: 0.2}}
dac: {bits: {choice: [11, 12]}, range: 60}
controller:
  units: si
  sample_rate: 4000
  ki: 8.0e+7
  coarse: {kp: 1.0e+6, ki: 5.0e+7, kd: 3000, encoder: coarse, coarse_beyond: 60, fine_within: 30, fine_rate: 2}
command: {units: si, targets: [5.0e-6, 0], hold: 0.2}
initial: {encoder_phase: {uniform: [0, 1]}}
goal: {band: 3, within: 0.1, moves: 0.9}
)";

constexpr std::string_view in_cascade = R"(zerocount: 1
name: cascade
seed: 8
trials: 40
command: {targets: [30, 0], hold: 0.2, profile: {shape: trapezoidal, velocity_limit: 0.01}}
initial: {encoder_phase: {uniform: [0, 1]}}
controller: {structure: cascade, cascade: {kv: {uniform: [20, 200]}, kp: 0.3, ki: 40}, missed: 0.3}
goal: {band: 1, within: 0.1, moves: 0.9}
)";

constexpr std::string_view of_a_joint = R"(zerocount: 1
name: joint
seed: 9
trials: 30
plant:
  inertia: 0.7
  sliding_damping: 12
  load: {inertia: 0.5, stiffness: {uniform: [2.0e+4, 5.0e+4]}, damping: 20, encoder: load,
    friction: {model: dahl, breakaway: {uniform: [0.5, 6]}, sigma0: 1.0e+4}}
friction: {model: dahl, breakaway: 5, sigma0: 3.0e+4}
encoder: {fine: 100000, load: {counts_per_revolution: 40000, fine_errors: {noise: 0.5}}}
dac: {range: 120, bits: 14}
controller: {sample_rate: 4000, structure: cascade,
  cascade: {kv: 18, kp: 600, ki: 3.0e+4, position: load, velocity: motor}}
command: {units: si, targets: [0.02], hold: 0.4}
initial: {encoder_phase: {uniform: [0, 1]}}
goal: {tolerance: 1.0e-4, within: 0.2, moves: 0.9}
)";

/// A row in the answer of the command `limits`, and the overrides with which a manifest describes the same
/// axis.
struct RowAndValues {
  std::string_view manifest;
  const char* cause;
  std::vector<std::string> values;
};

std::vector<RowAndValues> rows_and_values() {
  return {
      {in_counts,
       "twice the sample rate",
       {"controller.sample_rate=4000", "controller.ki={log_uniform: [2.5e-5, 1.5e-4]}",
        "controller.kd=6.0e-3", "controller.standstill.ki=2.5e-5", "controller.standstill.kd=4.0e-3"}},
      {in_counts,
       "an encoder 4 times finer",
       {"encoder.fine=1600000", "encoder.fine_errors.noise=1.2", "encoder.fine_errors.interpolation=2",
        "encoder.fine_errors.interpolation_period=16",
        "command.targets=[{choice: [12, 16, 20, 24, 28, 32]}, -8]",
        "controller.ki={log_uniform: [1.25e-5, 7.5e-5]}", "controller.kp=2.5e-5", "controller.kd=7.5e-4",
        "controller.integrator_zone=160", "controller.standstill.band=8", "controller.standstill.kp=5.0e-5",
        "controller.standstill.ki=1.25e-5", "controller.standstill.kd=5.0e-4", "goal.band=6"}},
      {in_counts,
       "a converter 16 times finer",
       {"dac.bits=16", "dac.resolution=1.5e-5", "dac.nonlinearity=9.6"}},
      {in_counts, "no delay", {"controller.delay=0"}},
      {in_counts, "no encoder noise", {"encoder.fine_errors.noise=0"}},
      {in_counts, "no converter noise", {"dac.noise=0"}},
      {in_counts, "no interpolation error", {"encoder.fine_errors.interpolation=0"}},
      {in_counts, "no converter non-linearity", {"dac.nonlinearity=0"}},
      {in_counts, "no zone of the integral", {"controller.integrator_zone=none"}},
      {in_counts, "no fall of friction from breakaway", {"friction.coulomb_ratio=1"}},
      {in_counts, "a torque range 8 times wider", {"dac.bits=15"}},
      {in_counts,
       "a torque range 50 times wider",
       {"dac.bits=18", fmt::format("amplifier.limit={}", 50 * 2048 * 2.4e-4)}},
      {in_counts, "no gains of standstill", {"controller.standstill={}"}},
      {in_counts, "no filter controller.filters.0", {"controller.filters=[]"}},
      {in_counts, "no integral of the control", {"controller.ki=0", "controller.standstill.ki=0"}},
      {in_counts, "creep off", {"friction.alpha=0"}},
      {of_two_phases,
       "twice the sample rate",
       {"controller.sample_rate=8000", "controller.coarse.fine_rate=1"}},
      {of_two_phases,
       "an encoder 4 times finer",
       {"encoder.resolution=5.0e-9", "encoder.coarse_resolution=2.5e-8", "encoder.fine_errors.noise=1.2",
        "encoder.coarse_errors.noise=0.8", "controller.coarse.coarse_beyond=240",
        "controller.coarse.fine_within=120", "controller.coarse.fine_rate=8", "goal.band=14"}},
      {of_two_phases, "a converter 16 times finer", {"dac.bits={choice: [15, 16]}"}},
      {of_two_phases, "no encoder noise", {"encoder.fine_errors.noise=0"}},
      {of_two_phases, "no noise of the coarse encoder", {"encoder.coarse_errors.noise=0"}},
      {of_two_phases, "a torque range 2 times wider", {"dac.bits={choice: [12, 13]}", "dac.range=120"}},
      {in_cascade, "twice the sample rate", {"controller.sample_rate=4000"}},
      {in_cascade, "no missed samples", {"controller.missed=0"}},
      {of_a_joint, "no friction of the load", {"plant.load.friction={model: none}"}},
      {of_a_joint, "an encoder 4 times finer on the motor", {"encoder.fine=400000"}},
      {of_a_joint,
       "an encoder 4 times finer on the load",
       {"encoder.load.counts_per_revolution=160000", "encoder.load.fine_errors.noise=2"}},
  };
}

// The rate without a cause is that of the manifest that describes it, to the last move.
TEST_F(Limits, EachRowEqualsARunOfItsManifest) {
  std::map<std::string_view, Json> found_for;
  for (const std::string_view manifest : {in_counts, of_two_phases, in_cascade, of_a_joint})
    found_for[manifest] = limits_of(std::string(manifest));
  for (const RowAndValues& one : rows_and_values()) {
    const Json& limits = found_for[one.manifest];
    const Json found = row(limits, one.cause);
    ASSERT_FALSE(found.is_null()) << one.cause << limits;
    EXPECT_DOUBLE_EQ(found["rate"], rate_with(std::string(one.manifest), one.values))
        << one.cause << one.manifest;
  }
  // The gains are not tuned again, which is noted where the cause is one of the loop.
  for (const Json& one : found_for[in_counts]) {
    const std::string cause = one["cause"];
    bool of_the_loop = false;
    for (const char* const word :
         {"rate", "an encoder", "delay", "zone", "standstill", "filter", "integral of the control"})
      of_the_loop = of_the_loop || cause.find(word) != std::string::npos;
    EXPECT_EQ(one["note"] == Json(noted), of_the_loop) << one;
  }
}

// A change is of one thing: where the study is without it, the row is absent or has the rate of the study.
TEST_F(Limits, ARowChangesNothingIfItsEffectIsAbsent) {
  for (const RowAndValues& one : rows_and_values()) {
    const std::string cause = one.cause;
    // A count, a code and a sample are never absent.
    if (cause.find("finer") != std::string::npos || cause == "twice the sample rate") continue;
    std::vector<std::string> words{"--set", "trials=12"};
    for (const std::string& value : one.values) words.insert(words.end(), {"--set", value});
    const Json limits = limits_of(std::string(one.manifest), words);
    const Json base = row(limits, "none");
    const Json found = row(limits, cause);
    EXPECT_EQ((found.is_null() ? base : found)["rate"], base["rate"]) << cause << one.manifest;
  }
}

// Every length in counts keeps its length, and what zero counts define keeps ± half an old count, whatever
// the goal limits.
TEST_F(Limits, AFinerEncoderKeepsEveryLengthOfTheGoal) {
  const std::string manifest = R"(zerocount: 1
name: lengths
seed: 11
trials: 40
friction: {k1: {lognormal: {median: 130, cv: 0.3}}}
encoder: {fine: 300000, fine_errors: {noise: 0.15}}
controller: {ki: {log_uniform: [8.0e-5, 8.0e-4]}, kp: 1.0e-4, deadband: {enter: 0}, hold: {enter: 0, dwell: 0.05}}
command: {targets: [{integers: [5, 40]}], hold: 0.2, profile: {shape: trapezoidal, velocity_limit: 0.01, acceleration_limit: 2}}
initial: {encoder_phase: {uniform: [0, 1]}}
verdict: {dwell: 0.01, window: 0.05, motion: true, rest_band: 1, bands: [3]}
)";
  const std::vector<std::string> finer{"encoder.fine=1200000",
                                       "encoder.fine_errors.noise=0.6",
                                       "controller.ki={log_uniform: [2.0e-5, 2.0e-4]}",
                                       "controller.kp=2.5e-5",
                                       "controller.deadband.enter=2",
                                       "controller.hold.enter=2",
                                       "command.targets=[{choice: [" +
                                           []() {
                                             std::string all;
                                             for (int target = 5; target <= 40; ++target)
                                               all +=
                                                   fmt::format("{}{}", all.empty() ? "" : ", ", 4 * target);
                                             return all;
                                           }() +
                                           "]}]",
                                       "verdict.rest_band=6"};
  struct Case {
    const char* goal;
    const char* finer_goal;
  };
  // A whole number of counts b is 4b + 2 finer counts, a real one 4b.
  const std::vector<Case> cases{
      {"{band: 3, within: 0.19, moves: 0.9, limits: {final_error: 0}}",
       "{band: 14, within: 0.19, moves: 0.9, limits: {final_error: 2}}"},
      {"{band: 3, within: 0.19, moves: 0.9, limits: {overshoot: 1, midway_error: 1}}",
       "{band: 14, within: 0.19, moves: 0.9, limits: {overshoot: 6, midway_error: 6}}"},
      {"{band: 3, within: 0.19, moves: 0.9, limits: {true_error: 0.6, rest_error_rms: 0.5}}",
       "{band: 14, within: 0.19, moves: 0.9, limits: {true_error: 2.4, rest_error_rms: 2}}"},
      {"{band: 3, within: 0.19, moves: 0.9, limits: {following_error_peak: 6}}",
       "{band: 14, within: 0.19, moves: 0.9, limits: {following_error_peak: 24}}"},
      {"{band: 3, within: 0.19, moves: 0.9, limits: {arrival_time: 0.1}}",
       "{band: 14, within: 0.19, moves: 0.9, limits: {\"band_entry_time[2]\": 0.1}}"},
      {"{band: 3, within: 0.19, moves: 0.9, limits: {final_settling_time: 0.12}}",
       "{band: 14, within: 0.19, moves: 0.9, limits: {\"band_settling_time[2]\": 0.12}}"},
      {"{band: 3, within: 0.19, moves: 0.9, limits: {jerk_count: 12}}",
       "{band: 14, within: 0.19, moves: 0.9, limits: {\"band_exits[2]\": 12}}"},
      {"{band: 0, within: 0.15, moves: 0.9}", "{band: 2, within: 0.15, moves: 0.9}"},
  };
  bool differ = false;
  for (const Case& one : cases) {
    const std::string goal = std::string("goal=") + one.goal;
    std::vector<std::string> values = finer;
    values.insert(values.end(), {"verdict.bands=[2, 14]", std::string("goal=") + one.finer_goal});
    const Json found = row(limits_of(manifest, {"--set", goal}), "an encoder 4 times finer");
    ASSERT_FALSE(found["rate"].is_null()) << goal << found;
    EXPECT_DOUBLE_EQ(found["rate"], rate_with(manifest, values)) << goal;
    differ = differ || found["rate"] != rate_with(manifest, {goal});
  }
  EXPECT_TRUE(differ) << "a finer encoder has no effect on these studies";
  // Without a goal moves are to end at zero counts, of the manifest.
  std::vector<std::string> zero = finer;
  zero.insert(zero.end(), {"verdict.bands=[2, 14]", "goal={band: 2, within: 0.15, moves: 0.9}"});
  EXPECT_DOUBLE_EQ(row(limits_of(manifest), "an encoder 4 times finer")["rate"], rate_with(manifest, zero));
}

// What depends on the zero counts of single samples cannot be told by another encoder.
TEST_F(Limits, RefuseALimitThatOnlyTheEncoderMeasures) {
  const Json finer = row(limits_of(std::string(in_counts), {"--set", "goal.limits={zero_fraction: 0.5}"}),
                         "an encoder 4 times finer");
  EXPECT_TRUE(finer["rate"].is_null());
  EXPECT_TRUE(says(finer["note"].get<std::string>(), "zero_fraction")) << finer;
}

// A rigid axis keeps what acts on the load: its friction, damping, disturbance and inertia.
TEST_F(Limits, ARigidAxisKeepsWhatActsOnItsLoad) {
  const std::string manifest = R"(zerocount: 1
name: two-masses
seed: 12
trials: 30
plant: {inertia: 4.0e-4, presliding_damping: 2.0e-3, sliding_damping: 3.0e-3, load: {inertia: 6.0e-4, stiffness: {uniform: [30, 90]},
  damping: 2.0e-3, damping_to_ground: {uniform: [0, 0.02]}, encoder: motor}}
friction: {model: none}
encoder: {fine: 200000}
dac: {bits: 16, range: 4}
controller: {sample_rate: 4000, delay: 1, structure: cascade, cascade: {kv: {uniform: [20, 60]}, kp: 0.4, ki: 20}}
command: {units: si, targets: [0.05], hold: 0.4}
initial: {encoder_phase: {uniform: [0, 1]}}
goal: {of: load, tolerance: 1.0e-3, within: 0.12, moves: 0.9}
)";
  const std::vector<std::string> one_mass{
      "plant={inertia: 1.0e-3, presliding_damping: {uniform: [0.002, 0.022]}, "
      "sliding_damping: {uniform: [0.002, 0.022]}}",
      "goal={tolerance: 1.0e-3, within: 0.12, moves: 0.9}"};
  struct Case {
    std::vector<std::string> load;
    std::vector<std::string> same;
  };
  const std::vector<Case> cases{
      {{"plant.load.damping_to_ground=0.01"}, {"plant.presliding_damping=0.012"}},
      {{"plant.load.damping_to_ground=0.01",
        "disturbance.load={torque: 0.05, vibration: [{amplitude: 0.01, frequency: 9}]}"},
       {"plant.presliding_damping=0.012",
        "disturbance={torque: 0.05, vibration: [{amplitude: 0.01, frequency: 9}]}"}},
      {{"plant.load.damping_to_ground=0.01",
        "plant.load.friction={model: coulomb, breakaway: 0.2, coulomb_ratio: 1}"},
       {"plant.sliding_damping=0.012", "friction={model: coulomb, breakaway: 0.2, coulomb_ratio: 1}"}},
      {{"plant.load.damping_to_ground=0.01",
        "plant.load.friction={model: lugre, breakaway: 0.2, sigma0: 300}"},
       {"plant.sliding_damping=0.012", "friction={model: lugre, breakaway: 0.2, sigma0: 300}"}},
      {{"plant.load.damping_to_ground=0.01",
        "plant.load.friction={model: dahl, breakaway: 0.2, sigma0: 300}"},
       {"plant.presliding_damping=0.012", "friction={model: dahl, breakaway: 0.2, sigma0: 300}"}},
      // Nothing can move it.
      {{"plant.load.damping_to_ground=0.01", "plant.load.friction={model: coulomb, breakaway: 9}"},
       {"plant.sliding_damping=0.012", "friction={model: coulomb, breakaway: 9}"}},
  };
  for (const Case& one : cases) {
    std::vector<std::string> options;
    for (const std::string& value : one.load) options.insert(options.end(), {"--set", value});
    std::vector<std::string> values = one_mass;
    values.insert(values.end(), one.same.begin(), one.same.end());
    const Json found = row(limits_of(manifest, options), "a rigid axis");
    ASSERT_FALSE(found["rate"].is_null()) << one.load.back() << found;
    EXPECT_DOUBLE_EQ(found["rate"], rate_with(manifest, values)) << one.load.back();
  }
  EXPECT_EQ(row(limits_of(manifest, {"--set", "plant.load.friction={model: coulomb, breakaway: 9}"}),
                "a rigid axis")["rate"],
            0.0);
}

// One mass has one friction, no gap and no kinematic error: the coupling gets stiffer, and these stay.
TEST_F(Limits, ACouplingThatCannotBeRigidIsStiffened) {
  const std::string manifest = R"(zerocount: 1
name: two-frictions
seed: 13
trials: 20
plant: {inertia: 4.0e-4, sliding_damping: 3.0e-3, load: {inertia: 6.0e-4, stiffness: {uniform: [30, 90]}, damping: 2.0e-3,
  encoder: motor}}
friction: {model: coulomb, breakaway: 0.05, coulomb_ratio: 1}
encoder: {fine: 200000}
dac: {bits: 16, range: 4}
controller: {sample_rate: 4000, delay: 1, structure: cascade, cascade: {kv: {uniform: [20, 60]}, kp: 0.4, ki: 20}}
command: {units: si, targets: [0.05], hold: 0.3}
initial: {encoder_phase: {uniform: [0, 1]}}
goal: {of: load, tolerance: 1.0e-3, within: 0.15, moves: 0.9}
)";
  for (const std::string load :
       {"plant.load.friction={model: coulomb, breakaway: 0.05, coulomb_ratio: 1}",
        "plant.load.gap={uniform: [0, 2.0e-3]}", "plant.load.error=[{amplitude: 1.0e-3, periods: 30}]"}) {
    const Json limits = limits_of(manifest, {"--set", load});
    EXPECT_TRUE(row(limits, "a rigid axis").is_null()) << load;
    EXPECT_DOUBLE_EQ(row(limits, "a coupling 100 times stiffer")["rate"],
                     rate_with(manifest, {load, "plant.load.stiffness={uniform: [3000, 9000]}"}))
        << load;
  }
}

// A window of the derivative, a position loop of a host and a bus are times: a row of their own each.
TEST_F(Limits, TimesGivenInSamplesAreKept) {
  const std::string manifest = R"(zerocount: 1
name: window
seed: 14
trials: 20
plant: {inertia: 2.0e-4, presliding_damping: 2.0e-3}
friction: {model: none}
encoder: {fine: 1000000}
dac: {bits: 18, range: 4}
controller:
  sample_rate: 8000
  delay: 1
  structure: cascade
  derivative_window: {choice: [1, 60, 100, 140]}
  cascade: {kv: {uniform: [20, 60]}, kp: 0.03, ki: 0.3, divider: {choice: [1, 40]}, latency: {choice: [0, 20]}}
command: {units: si, targets: [0.05], hold: 0.4}
initial: {encoder_phase: {uniform: [0, 1]}}
goal: {tolerance: 1.0e-4, within: 0.3, moves: 0.8}
)";
  const Json limits = limits_of(manifest);
  const auto expect_row = [&](const char* cause, const std::vector<std::string>& values) {
    EXPECT_DOUBLE_EQ(row(limits, cause)["rate"], rate_with(manifest, values)) << cause;
  };
  expect_row(
      "twice the sample rate",
      {"controller.sample_rate=16000", "controller.derivative_window={choice: [1, 120, 200, 280]}",
       "controller.cascade.divider={choice: [1, 80]}", "controller.cascade.latency={choice: [0, 40]}"});
  expect_row("a derivative window of one sample", {"controller.derivative_window=1"});
  expect_row("a position loop at every sample", {"controller.cascade.divider=1"});
  expect_row("no latency of the velocity command", {"controller.cascade.latency=0"});
}

// The feed-forward that an axis needs is that of its own inertia, damping and friction.
TEST_F(Limits, TryTheIdealFeedForwardAndProfile) {
  const std::string manifest = R"(zerocount: 1
name: follower
seed: 15
trials: 20
plant: {inertia: 2.0e-3, presliding_damping: 0.01, sliding_damping: 0.05}
friction: {model: coulomb, breakaway: 0.4, coulomb_ratio: 0.75, stribeck_velocity: 5.0e-3}
encoder: {fine: 200000}
dac: {bits: 18, range: 8}
controller: {units: si, sample_rate: 4000, kp: {uniform: [20, 60]}, ki: 300, kd: 0.3}
command: {units: si, targets: [0.3, 0], hold: 0.8, profile: {shape: s_curve, velocity_limit: 1, acceleration_limit: 20, jerk_limit: 1000}}
initial: {encoder_phase: {uniform: [0, 1]}}
verdict: {motion: true}
goal: {tolerance: 1.0e-3, within: 0.6, moves: 0.9, limits: {following_error_rms: 220}}
)";
  const Json limits = limits_of(manifest);
  const auto expect_row = [&](const char* cause, const std::vector<std::string>& values) {
    ASSERT_FALSE(row(limits, cause).is_null()) << cause << limits;
    EXPECT_DOUBLE_EQ(row(limits, cause)["rate"], rate_with(manifest, values)) << cause;
  };
  expect_row("a feed-forward of the inertia", {"controller.feedforward.acceleration=2.0e-3"});
  expect_row("a feed-forward of the damping", {"controller.feedforward.velocity=0.35"});
  expect_row("a feed-forward of the sliding friction", {"controller.feedforward.friction=0.3"});
  expect_row("no integral of the control", {"controller.ki=0"});
  expect_row("a profile 2 times faster",
             {"command.profile.velocity_limit=2", "command.profile.acceleration_limit=80",
              "command.profile.jerk_limit=8000"});
  // A step has no profile and is not followed.
  for (const Json& one :
       limits_of(manifest, {"--set", "command.profile={}", "--set", "goal.limits={overshoot: 1.0e+9}"})) {
    EXPECT_FALSE(says(one["cause"].get<std::string>(), "a profile")) << one;
    EXPECT_FALSE(says(one["cause"].get<std::string>(), "feed-forward")) << one;
  }
}

// Where the coarse encoder closes the loop, it is the one that is refined; nothing else is.
TEST_F(Limits, OnlyTheEncoderThatClosesTheLoopIsRefined) {
  const std::string manifest = R"(zerocount: 1
name: coarse
seed: 3
trials: 60
encoder: {fine: 1000000, coarse: 40000}
controller: {units: si, sample_rate: 4000, ki: 1.0e+4, encoder: coarse}
command: {targets: [{integers: [-90, 90]}], hold: 0.3}
initial: {encoder_phase: {uniform: [0, 1]}}
goal: {band: 8, within: 0.1, moves: 0.95}
)";
  const Json finer = row(limits_of(manifest), "an encoder 4 times finer");
  EXPECT_DOUBLE_EQ(finer["rate"], rate_with(manifest, {"encoder.coarse=160000"}));
  EXPECT_GT(finer["rate"].get<double>(), rate_with(manifest, {}));
}

// A cause is there if a trial can have it, whichever trials the seed draws; one that none can have is not. Of
// causes that are read off the drawn trials, all are there with all three seeds three times in ten thousand.
TEST_F(Limits, CausesDoNotDependOnTheSeed) {
  const std::string manifest = R"(zerocount: 1
name: rare-causes
seed: 1
trials: 2
machines: 2
friction: {alpha: {choice: [0, 0, 0, 0, 0.5]}, model: presliding}
encoder: {coarse_errors: {noise: 0.5}}
amplifier: {bandwidth: 0}
controller: {ki: 2.0e-5, delay: {choice: [0, 0, 0, 2], per: machine}, missed: {uniform: [0, 0.01]}}
disturbance: {ripple: [{amplitude: {choice: [0, 0, 0, 1.0e-3]}, periods: 40}]}
command: {targets: [10], hold: 0.2}
goal: {band: 1, within: 0.1, moves: 0.9}
)";
  for (int seed = 1; seed < 4; ++seed) {
    const Json limits = limits_of(manifest, {"--set", fmt::format("seed={}", seed)});
    for (const char* cause : {"creep off", "no delay", "no ripple disturbance.ripple.0", "no missed samples"})
      EXPECT_FALSE(row(limits, cause).is_null()) << cause << " with seed " << seed;
    EXPECT_TRUE(row(limits, "no noise of the coarse encoder").is_null())
        << "the coarse encoder does not close the loop";
  }
  const Json limits = limits_of(manifest, {"--set", "friction.model=spring", "--set", "controller.delay=0",
                                           "--set", "controller.missed=0", "--set", "disturbance.ripple=[]"});
  for (const Json& one : limits) {
    const std::string cause = one["cause"];
    EXPECT_TRUE(cause == "none" || cause.find("finer") != std::string::npos ||
                cause.find("a torque range") != std::string::npos ||
                cause == "no fall of friction from breakaway" ||
                cause.find("twice the sample rate") != std::string::npos)
        << cause;
  }
}

// What a manifest cannot describe is not simulated, and the reason is given.
TEST_F(Limits, CausesThatAreNotSimulatedGiveTheReason) {
  const std::string late = R"(zerocount: 1
name: late
seed: 2
trials: 20
dac: {bits: 30, resolution: 1.0e-9}
controller: {ki: 2.0e-5, filters: [{biquad: {b: [0.5, 0.5, 0], a: [1, 0]}}]}
command: {targets: [10], hold: 0.2}
goal: {band: 1, within: 0.02, moves: 0.9}
)";
  const Json limits = limits_of(late);
  EXPECT_TRUE(row(limits, "a converter 16 times finer")["rate"].is_null()) << limits;
  EXPECT_TRUE(says(row(limits, "a converter 16 times finer")["note"].get<std::string>(), "dac.bits"));
  EXPECT_TRUE(row(limits, "twice the sample rate")["rate"].is_null());
  EXPECT_TRUE(
      says(row(limits, "twice the sample rate")["note"].get<std::string>(), "pole at half the sample rate"))
      << limits;
  const Json jitter = row(limits_of(late, {"--set", "controller.jitter={uniform: [0, 3.0e-4]}", "--set",
                                           "controller.filters=[]"}),
                          "twice the sample rate");
  EXPECT_TRUE(jitter["rate"].is_null()) << jitter;
  EXPECT_TRUE(says(jitter["note"].get<std::string>(), "controller.jitter")) << jitter;
  const std::string text = zerocount_program({"limits", "axis.yaml"}, folder_.path()).out;
  EXPECT_TRUE(says(text, noted));
}

// Where nothing is missed no cause can be at fault: none is simulated, and each row says so.
TEST_F(Limits, SimulateNoCauseIfNoMoveMisses) {
  const std::string manifest = R"(zerocount: 1
name: met
seed: 2
trials: 20
controller: {ki: 2.0e-5}
command: {targets: [10], hold: 0.3}
goal: {band: 2, within: 0.25, moves: 0.9}
)";
  const Json limits = limits_of(manifest);
  EXPECT_EQ(limits[0]["rate"], 1.0);
  EXPECT_GE(limits.size(), 5U) << limits;
  for (std::size_t i = 1; i < limits.size(); ++i) {
    EXPECT_TRUE(limits[i]["rate"].is_null()) << limits[i];
    EXPECT_EQ(limits[i]["note"], "nothing is missed") << limits[i];
  }
}

// The load of a machine and the integral that carries it are drawn together, and go together.
TEST_F(Limits, RemovingALoadRemovesTheIntegralThatHoldsIt) {
  folder_.write("loads.csv", "disturbance.torque,initial.integral\n-100,100\n-110,110\n-90,90\n-20,20\n");
  const std::string manifest = R"(zerocount: 1
name: z-axis
axis: linear
seed: 4
trials: 20
plant: {inertia: 12, presliding_damping: 1500, sliding_damping: 100}
friction: {k1: 1.0e+5, k2: 2.0e+6, beta: 1.0e+6, alpha: 0, breakaway: 15, stribeck_velocity: 1.0e-3}
encoder: {resolution: 1.0e-7}
dac: {bits: 16, range: 400}
controller: {units: si, sample_rate: 4000, kp: 1.0e+6, ki: 2.0e+7, kd: 5000}
command: {targets: [0, 1000], hold: 0.3}
goal: {band: 2, within: 0.1, moves: 0.95}
)";
  const double without = rate_with(manifest, {});
  for (const char* load : {"samples: loads.csv\n",
                           "disturbance: {torque: {uniform: [-110, -90]}}\n"
                           "initial: {integral: 100}\n",
                           "disturbance: {torque: 9}\ninitial: {holding: true}\n",
                           "disturbance: {torque: 9}\ninitial: {preload: -9}\n"}) {
    EXPECT_EQ(row(limits_of(manifest + load), "no constant disturbance")["rate"], without) << load;
  }
  // An integral that no load explains stays.
  EXPECT_EQ(row(limits_of(manifest + "disturbance: {torque: -1}\ninitial: {integral: 80}\n"),
                "no constant disturbance")["rate"],
            rate_with(manifest, {"initial.integral=79"}));
}

// So do a load on a second mass, and gravity that is a ripple of one period.
TEST_F(Limits, RemovingALoadOfTheSecondMassRemovesTheIntegralThatHoldsIt) {
  const std::string manifest = R"(zerocount: 1
name: tilting-arm
seed: 16
trials: 16
plant: {inertia: 0.2, presliding_damping: 1, load: {inertia: 0.3, stiffness: 5.0e+4, damping: 10, encoder: load}}
friction: {model: none}
encoder: {fine: 2000000}
dac: {bits: 20, range: 40}
controller: {units: si, sample_rate: 4000, kp: 2000, ki: 2.0e+4, kd: 60}
command: {units: si, targets: [0, 1.0e-3], hold: 0.3}
initial: {position: 1.2}
goal: {tolerance: 1.0e-5, within: 0.25, moves: 0.9}
)";
  const double without = rate_with(manifest, {});
  struct Case {
    std::vector<std::string> load;
    const char* cause;
  };
  const double gravity = 9.0 * std::sin(1.2);
  for (const Case& one : {Case{{"disturbance={load: {torque: 9}}", "initial.integral=-9"},
                               "no constant disturbance of the load"},
                          Case{{"disturbance={load: {ripple: [{amplitude: 9, periods: 1}]}}",
                                fmt::format("initial.integral={}", -gravity)},
                               "no ripple disturbance.load.ripple.0"},
                          Case{{"disturbance={ripple: [{amplitude: 9, periods: 1}]}",
                                fmt::format("initial.integral={}", -gravity)},
                               "no ripple disturbance.ripple.0"}}) {
    std::vector<std::string> options;
    for (const std::string& value : one.load) options.insert(options.end(), {"--set", value});
    const Json limits = limits_of(manifest, options);
    EXPECT_EQ(row(limits, one.cause)["rate"], without) << one.cause << limits;
    EXPECT_TRUE(row(limits, "no integral at the start").is_null()) << one.cause;
  }
}

class LimitsOfAxis : public Tune {};

TEST_F(LimitsOfAxis, AreThoseOfTheSelectedPoint) {
  write_axis("goal: {band: 0, within: 0.05, moves: 0.98}\nsweep: {grid: {controller.delay: [0, 1]}}\n");
  EXPECT_TRUE(says(program({"limits", "axis.yaml"}).err, "expected one with --point"));
  const auto rate_of = [this](const std::vector<std::string>& words) {
    return Json::parse(program(words).out)["limits"][0]["rate"].get<double>();
  };
  const double swept = rate_of({"limits", "axis.yaml", "--point", "1", "--format", "json"});
  write_axis("goal: {band: 0, within: 0.05, moves: 0.98}\n");
  EXPECT_EQ(rate_of({"limits", "axis.yaml", "--format", "json"}), swept);
}

TEST_F(LimitsOfAxis, ReportObjectionsOfTheTheoryAndTheSmallestBudget) {
  write_axis("goal: {band: 0, within: 0.05, moves: 0.98}\n");
  const std::string objection = "by the linear theory (`zerocount check`), ";
  EXPECT_TRUE(says(program({"limits", "axis.yaml", "--set", "controller.ki=1.0e-3"}).out, objection));
  EXPECT_FALSE(says(program({"limits", "axis.yaml", "--set", "goal.band=1000"}).out, objection));
  const ProgramResult refused = program({"limits", "axis.yaml", "--budget", "50"});
  EXPECT_EQ(refused.code, 2);
  const std::string words = "expected ";
  const std::string least = refused.err.substr(refused.err.rfind(words) + words.size());
  const std::string trials = least.substr(0, least.find(' '));
  EXPECT_EQ(program({"limits", "axis.yaml", "--budget", trials}).code, 0) << refused.err;
}

}  // namespace
}  // namespace zerocount::testing
