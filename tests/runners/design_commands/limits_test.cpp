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

  /// Rate of the goal of the manifest with these values.
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

// The rate without a cause is that of the manifest that describes it, to the last move.
TEST_F(Limits, AreTheRatesOfTheManifestsThatTheyStandFor) {
  const std::string counts(in_counts);
  const std::string phases(of_two_phases);
  const std::string cascade = R"(zerocount: 1
name: cascade
seed: 8
trials: 40
command: {targets: [30, 0], hold: 0.2, profile: {shape: trapezoidal, velocity_limit: 0.01}}
initial: {encoder_phase: {uniform: [0, 1]}}
controller: {structure: cascade, cascade: {kv: {uniform: [20, 200]}, kp: 0.3, ki: 40}, missed: 0.3}
goal: {band: 1, within: 0.1, moves: 0.9}
)";
  const std::string joint = R"(zerocount: 1
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
  struct Case {
    const std::string& manifest;
    const char* cause;
    std::vector<std::string> values;
  };
  const std::vector<Case> cases{
      {counts,
       "twice the sample rate",
       {"controller.sample_rate=4000", "controller.ki={log_uniform: [2.5e-5, 1.5e-4]}",
        "controller.kd=6.0e-3", "controller.standstill.ki=2.5e-5", "controller.standstill.kd=4.0e-3"}},
      {counts,
       "an encoder 4 times finer",
       {"encoder.fine=1600000", "encoder.fine_errors.noise=1.2", "encoder.fine_errors.interpolation=2",
        "encoder.fine_errors.interpolation_period=16",
        "command.targets=[{choice: [12, 16, 20, 24, 28, 32]}, -8]",
        "controller.ki={log_uniform: [1.25e-5, 7.5e-5]}", "controller.kp=2.5e-5", "controller.kd=7.5e-4",
        "controller.integrator_zone=160", "controller.standstill.band=8", "controller.standstill.kp=5.0e-5",
        "controller.standstill.ki=1.25e-5", "controller.standstill.kd=5.0e-4", "goal.band=6"}},
      {counts,
       "a converter 16 times finer",
       {"dac.bits=16", "dac.resolution=1.5e-5", "dac.nonlinearity=9.6"}},
      {counts, "no delay", {"controller.delay=0"}},
      {counts, "no encoder noise", {"encoder.fine_errors.noise=0"}},
      {counts, "no converter noise", {"dac.noise=0"}},
      {counts, "no interpolation error", {"encoder.fine_errors.interpolation=0"}},
      {counts, "no converter non-linearity", {"dac.nonlinearity=0"}},
      {counts, "no zone of the integral", {"controller.integrator_zone=none"}},
      {counts, "no fall of friction from breakaway", {"friction.coulomb_ratio=1"}},
      {counts, "a torque range 10 times wider", {"dac.bits=15", "dac.resolution=3.0e-4"}},
      {counts, "creep off", {"friction.alpha=0"}},
      {phases, "twice the sample rate", {"controller.sample_rate=8000", "controller.coarse.fine_rate=1"}},
      {phases,
       "an encoder 4 times finer",
       {"encoder.resolution=5.0e-9", "encoder.coarse_resolution=2.5e-8", "encoder.fine_errors.noise=1.2",
        "encoder.coarse_errors.noise=0.8", "controller.coarse.coarse_beyond=240",
        "controller.coarse.fine_within=120", "controller.coarse.fine_rate=8", "goal.band=14"}},
      {phases, "a converter 16 times finer", {"dac.bits={choice: [15, 16]}"}},
      {phases, "no encoder noise", {"encoder.fine_errors.noise=0"}},
      {phases, "no noise of the coarse encoder", {"encoder.coarse_errors.noise=0"}},
      {phases, "a torque range 2 times wider", {"dac.bits={choice: [12, 13]}", "dac.range=120"}},
      {cascade, "twice the sample rate", {"controller.sample_rate=4000"}},
      {cascade, "no missed samples", {"controller.missed=0"}},
      {joint, "no friction of the load", {"plant.load.friction={model: none}"}},
      {joint, "an encoder 4 times finer on the motor", {"encoder.fine=400000"}},
      {joint,
       "an encoder 4 times finer on the load",
       {"encoder.load.counts_per_revolution=160000", "encoder.load.fine_errors.noise=2"}},
  };
  std::map<std::string, Json> found_for;
  for (const std::string* manifest : {&counts, &phases, &cascade, &joint})
    found_for[*manifest] = limits_of(*manifest);
  for (const Case& one : cases) {
    const Json& limits = found_for[one.manifest];
    const Json found = row(limits, one.cause);
    ASSERT_FALSE(found.is_null()) << one.cause << limits;
    EXPECT_DOUBLE_EQ(found["rate"], rate_with(one.manifest, one.values)) << one.cause << one.manifest;
  }
  // The gains are not tuned again, which is noted where the cause is one of the loop.
  for (const Json& one : found_for[counts]) {
    const std::string cause = one["cause"];
    const bool of_the_loop =
        cause.find("rate") != std::string::npos || cause.find("an encoder") != std::string::npos ||
        cause.find("delay") != std::string::npos || cause.find("zone") != std::string::npos;
    EXPECT_EQ(one["note"] == Json(noted), of_the_loop) << one;
  }
}

// Where the coarse encoder closes the loop, it is the one that is refined; nothing else is.
TEST_F(Limits, RefineTheEncoderThatClosesTheLoop) {
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
TEST_F(Limits, HaveTheSameCausesForEverySeed) {
  const std::string manifest = R"(zerocount: 1
name: rare-causes
seed: 1
trials: 2
rigs: 2
friction: {alpha: {choice: [0, 0, 0, 0, 0.5]}, model: presliding}
encoder: {coarse_errors: {noise: 0.5}}
amplifier: {bandwidth: 0}
controller: {ki: 2.0e-5, delay: {choice: [0, 0, 0, 2], per: rig}, missed: {uniform: [0, 0.01]}}
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
TEST_F(Limits, SayWhatTheyDoNotSimulate) {
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
TEST_F(Limits, SimulateNoCauseWhereNothingIsMissed) {
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
TEST_F(Limits, TakeALoadAwayWithWhatHoldsIt) {
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

class LimitsOfAxis : public Tune {};

TEST_F(LimitsOfAxis, AreOfThePointThatIsAskedFor) {
  write_axis("goal: {band: 0, within: 0.05, moves: 0.98}\nsweep: {grid: {controller.delay: [0, 1]}}\n");
  EXPECT_TRUE(says(program({"limits", "axis.yaml"}).err, "expected one with --point"));
  const auto rate_of = [this](const std::vector<std::string>& words) {
    return Json::parse(program(words).out)["limits"][0]["rate"].get<double>();
  };
  const double swept = rate_of({"limits", "axis.yaml", "--point", "1", "--format", "json"});
  write_axis("goal: {band: 0, within: 0.05, moves: 0.98}\n");
  EXPECT_EQ(rate_of({"limits", "axis.yaml", "--format", "json"}), swept);
}

TEST_F(LimitsOfAxis, SayWhatTheTheoryObjectsToAndTheLeastBudget) {
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
