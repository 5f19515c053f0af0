// `limits`: a study for each parameter that has an ideal value, in which this parameter is the cause of
// failures. Every such parameter of the table has one here.

#include "experiments/parameters/parameter_table.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

using Words = std::vector<std::string>;

// Every move meets the goal.
constexpr const char* faultless_axis = R"(zerocount: 1
name: cause
seed: 1
trials: 24
plant: {inertia: 1.0e-3, presliding_damping: 1.0e-2}
friction: {model: none}
encoder: {fine: 100000}
dac: {bits: 24, range: 20}
controller: {units: si, sample_rate: 4000, kp: 40, ki: 0, kd: 0.28}
command:
  targets: [400, 0]
  hold: 0.3
  profile: {shape: s_curve, velocity_limit: 1, acceleration_limit: 20, jerk_limit: 2000}
initial: {encoder_phase: {uniform: [0, 1]}}
goal: {band: 2, within: 0.2, moves: 0.9}
)";

const std::string by_position = "goal={tolerance: 3.0e-4, within: 0.2, moves: 0.9}";
const std::string settled_soon = "goal={band: 2, within: 0.05, moves: 0.9}";
const std::string of_the_coarse_encoder = "controller.encoder=coarse";

Words under_a_load(const std::string& block) {
  return {block, "disturbance.torque=1", "controller.ki=2000", "command.hold=0.6", "goal.within=0.5"};
}

/// Overrides for a study of a cascade control, with the keys `more` that add one cause of failure.
Words as_a_host(const std::string& more) {
  return {"controller={sample_rate: 4000, structure: cascade, cascade: {kv: 100, kp: 0.3, ki: 0, " + more +
          "}}"};
}

/// Overrides for a study with a stiff second mass that has the keys `more`, and the overrides `given`.
Words with_a_load(const std::string& more, Words given = {}) {
  given.push_back("plant.load={inertia: 1.0e-3, stiffness: 1.0e+4, damping: 0.1, " + more + "}");
  return given;
}

Words on_the_coarse_encoder(Words with) {
  with.insert(with.end(), {of_the_coarse_encoder, "encoder.coarse=100000", by_position});
  return with;
}

/// Overrides for a study in which an encoder with these errors, on a stiff second mass, closes the loop.
Words on_the_loads_encoder(const std::string& errors, Words given = {by_position}) {
  given.push_back("encoder.load={counts_per_revolution: 100000, fine_errors: {" + errors + "}}");
  return with_a_load("encoder: load", given);
}

/// Overrides for a study whose reference moves, so that the loop must follow it, and the overrides `more`.
Words following(Words more) {
  more.insert(more.end(),
              {"command={targets: [4000], hold: 0.5, profile: {shape: trapezoidal, velocity_limit: 2, "
               "acceleration_limit: 40}}",
               "verdict.motion=true"});
  return more;
}

/// A control whose integral is too large for an axis with friction, which needs none within this band
/// (counts).
Words with_friction(const std::string& controller, int band) {
  return {controller,
          "friction={model: coulomb, breakaway: 0.4, coulomb_ratio: 0.4, stribeck_velocity: 5.0e-3}",
          "plant.sliding_damping=0.01", "command.hold=0.8",
          fmt::format("goal={{band: {}, within: 0.3, moves: 0.9}}", band)};
}

// [parameter] what makes it the cause
const std::map<std::string, Words, std::less<>>& causes_of_failures() {
  static const std::map<std::string, Words, std::less<>> all{
      {"plant.load.inertia", {"plant.load={inertia: 1.0e-3, stiffness: 60, damping: 1.0e-3, encoder: load}"}},
      {"plant.load.stiffness",
       {"plant.load={inertia: 1.0e-3, stiffness: 60, damping: 1.0e-3, encoder: load, friction: {model: "
        "coulomb, "
        "breakaway: 0.02, coulomb_ratio: 1}}",
        "friction={model: coulomb, breakaway: 0.02, coulomb_ratio: 1}",
        "goal={tolerance: 8.0e-4, within: 0.2, moves: 0.9}"}},
      {"plant.load.friction.model", with_a_load("encoder: load, friction: {model: coulomb, breakaway: 2}")},
      {"plant.load.friction.coulomb_ratio",
       with_a_load("encoder: load, friction: {model: coulomb, breakaway: 0.4, coulomb_ratio: 0.4, "
                   "stribeck_velocity: 5.0e-3}",
                   {"controller.kp=400", "controller.kd=1.2", "controller.ki=20000", "command.hold=0.8",
                    "goal={band: 9, within: 0.4, moves: 0.9}"})},
      {"plant.load.gap", with_a_load("encoder: load, gap: 0.01")},
      {"plant.load.error.#.amplitude",
       with_a_load("error: [{amplitude: 1.0e-6, periods: 3}, {amplitude: 0.1, periods: 20}]",
                   {"initial.position={uniform: [0, 6.28]}"})},
      {"disturbance.load.torque", with_a_load("encoder: load", {"disturbance.load.torque=1"})},
      {"disturbance.load.ripple.#.amplitude",
       with_a_load("encoder: load", {"disturbance.load.ripple=[{amplitude: 1.0e-4, periods: 7}, "
                                     "{amplitude: 1, periods: 40}]"})},
      {"disturbance.load.vibration.#.amplitude",
       with_a_load("encoder: load", {"disturbance.load.vibration=[{amplitude: 1.0e-4, frequency: 30}, "
                                     "{amplitude: 1, frequency: 20}]"})},
      {"friction.alpha",
       {"friction={k1: 100, k2: 700, beta: 4000, alpha: 20, lambda: 3, n: 1, breakaway: 0.05}",
        "plant.presliding_damping=0.2", "disturbance.torque=0.03", "initial.holding=true",
        "controller={sample_rate: 4000, ki: 0}", "command.targets=[0]"}},
      {"friction.coulomb_ratio",
       {"friction={model: coulomb, breakaway: 0.4, coulomb_ratio: 0.4, stribeck_velocity: 5.0e-3}",
        "plant.sliding_damping=0.01", "controller.ki=1000", "command.hold=0.8", "goal.within=0.3"}},
      {"encoder.fine",
       {"encoder.fine=2000", "command.targets=[8, 0]", "goal={tolerance: 1.0e-3, within: 0.2, moves: 0.9}"}},
      {"encoder.coarse",
       {"encoder.coarse=2000", of_the_coarse_encoder, "goal={tolerance: 1.0e-3, within: 0.2, moves: 0.9}"}},
      {"encoder.fine_errors.eccentricity", {"encoder.fine_errors.eccentricity=5.0e-2", by_position}},
      {"encoder.fine_errors.interpolation",
       {"encoder.fine_errors={interpolation: 20, interpolation_period: 1000}", by_position,
        "initial.position={uniform: [0, 6.28]}"}},
      {"encoder.fine_errors.noise", {"encoder.fine_errors.noise=2"}},
      {"encoder.fine_errors.missed", {"encoder.fine_errors.missed=0.05", by_position}},
      {"encoder.coarse_errors.eccentricity",
       on_the_coarse_encoder({"encoder.coarse_errors.eccentricity=5.0e-2"})},
      {"encoder.coarse_errors.interpolation",
       on_the_coarse_encoder({"encoder.coarse_errors={interpolation: 20, interpolation_period: 1000}",
                              "initial.position={uniform: [0, 6.28]}"})},
      {"encoder.coarse_errors.noise", on_the_coarse_encoder({"encoder.coarse_errors.noise=10"})},
      {"encoder.coarse_errors.missed", on_the_coarse_encoder({"encoder.coarse_errors.missed=0.05"})},
      {"encoder.load.counts_per_revolution",
       with_a_load("encoder: load", {"encoder.load.counts_per_revolution=2000", "command.targets=[8, 0]",
                                     "goal={tolerance: 1.0e-3, within: 0.2, moves: 0.9}"})},
      {"encoder.load.fine_errors.eccentricity", on_the_loads_encoder("eccentricity: 5.0e-2")},
      {"encoder.load.fine_errors.interpolation",
       on_the_loads_encoder("interpolation: 20, interpolation_period: 1000",
                            {by_position, "initial.position={uniform: [0, 6.28]}"})},
      {"encoder.load.fine_errors.noise", on_the_loads_encoder("noise: 2", {})},
      {"encoder.load.fine_errors.missed", on_the_loads_encoder("missed: 0.05")},
      {"dac.bits", {"dac.bits=8"}},
      {"dac.range", {"dac.range=0.01"}},
      {"dac.offset", {"dac.offset=0.5"}},
      {"dac.gain_error", {"dac.gain_error=-0.97"}},
      {"dac.nonlinearity", {"dac.nonlinearity=2.0e6"}},
      {"dac.noise", {"dac.noise=2"}},
      {"amplifier.bandwidth", {"amplifier.bandwidth=15"}},
      {"controller.sample_rate", {"controller.sample_rate=130"}},
      {"controller.delay", {"controller.delay=20"}},
      {"controller.dither.amplitude", {"controller.dither={amplitude: 1, frequency: 50}"}},
      {"controller.missed", {"controller.missed=0.97"}},
      {"controller.jitter", {"controller.sample_rate=250", "controller.jitter=3.9e-3"}},
      {"controller.derivative_window",
       {"controller={sample_rate: 4000, structure: cascade, cascade: {kv: 100, kp: 0.3, ki: 0}, "
        "derivative_window: 120}"}},
      {"controller.standstill.band",
       {"controller.standstill={band: 100, dwell: 0.001, kp: 0.1, ki: 0, kd: 0}"}},
      {"controller.filters.#.frequency", {"controller.filters=[{lowpass: {frequency: 6, damping: 0.7}}]"}},
      {"controller.filters.#.b", {"controller.filters=[{biquad: {b: [0.01, 0, 0], a: [0, 0]}}]"}},
      {"controller.ki",
       with_friction("controller={units: si, sample_rate: 4000, kp: 400, ki: 6.0e+5, kd: 0.9}", 12)},
      {"controller.standstill.ki",
       with_friction(
           "controller={units: si, sample_rate: 4000, kp: 400, ki: 0, kd: 0.9, standstill: {band: 100, "
           "dwell: 0.01, kp: 400, ki: 6.0e+5, kd: 0.9}}",
           12)},
      {"controller.cascade.feedforward",
       {as_a_host("feedforward: 0").front(), "goal.limits={following_error_peak: 100}",
        "command={targets: [4000], hold: 0.5, profile: {shape: s_curve, velocity_limit: 2, "
        "acceleration_limit: 40, jerk_limit: 2000}}",
        "verdict.motion=true"}},
      {"controller.feedforward.velocity",
       following({"goal.limits={following_error_rms: 100}", "controller.kd=0.6"})},
      {"controller.feedforward.acceleration",
       following({"goal.limits={following_error_peak: 8}", "controller.feedforward={velocity: 0.29}"})},
      {"controller.feedforward.friction",
       following({"friction={model: coulomb, breakaway: 1, coulomb_ratio: 1}",
                  "controller.feedforward={velocity: 0.281, acceleration: 1.0e-3}",
                  "goal={tolerance: 1, within: 0.4, moves: 0.9, limits: {following_error_rms: 30}}"})},
      {"command.profile.velocity_limit", {"command.profile.velocity_limit=0.05", "command.hold=0.6"}},
      {"command.profile.acceleration_limit",
       {"command.profile.acceleration_limit=1", "goal.within=0.15", "command.hold=0.6"}},
      {"command.profile.jerk_limit", {"command.profile.jerk_limit=8", "goal.within=0.2", "command.hold=0.6"}},
      {"controller.cascade.divider", as_a_host("divider: 200")},
      {"controller.cascade.latency", as_a_host("latency: 200")},
      {"controller.cascade.resolution", as_a_host("resolution: 5")},
      {"controller.cascade.limit", as_a_host("limit: 1.0e-2")},
      {"amplifier.limit", {"amplifier.limit=0.01"}},
      {"controller.deadband.enter", under_a_load("controller.deadband={enter: 30}")},
      {"controller.integrator_zone", under_a_load("controller.integrator_zone=5")},
      {"controller.integrator_leak", under_a_load("controller.integrator_leak=0.01")},
      {"controller.derivative_cutoff", {"controller.derivative_cutoff=3"}},
      {"controller.error_deadband.band", {"controller.error_deadband={band: 20, form: subtract}"}},
      {"controller.hold.enter", {"controller.hold={enter: 30, leave: 60, dwell: 0}"}},
      {"disturbance.torque", {"disturbance.torque=1"}},
      {"disturbance.ripple.#.amplitude",
       {"disturbance.ripple=[{amplitude: 1.0e-4, periods: 7}, {amplitude: 1, periods: 40}]"}},
      {"disturbance.vibration.#.amplitude",
       {"disturbance.vibration=[{amplitude: 1.0e-4, frequency: 30}, {amplitude: 1, frequency: 20}]"}},
      {"initial.velocity", {"initial.velocity=100", settled_soon, "command.targets=[0]"}},
      {"initial.integral", {"initial.integral=5", "controller.ki=400", settled_soon, "command.targets=[0]"}}};
  return all;
}

class Causes : public ProgramTest {
 protected:
  Json limits_with(const Words& values) {
    folder_.write("axis.yaml", faultless_axis);
    Words words{"limits", "axis.yaml", "--format", "json"};
    for (const std::string& value : values) words.insert(words.end(), {"--set", value});
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.code == 0 ? Json::parse(result.out) : Json{};
  }
};

/// Whether the parameter's row can be left out of a test because it is tested by another row: parameters of
/// the coarse phase by those of the fine phase, those of a linear axis by those of a rotary axis, and the
/// integral of a cascade by that of a PID.
bool has_a_twin(const parameters::Parameter& row) {
  return row.name.starts_with("controller.coarse.") || row.name == "encoder.resolution" ||
         row.name == "encoder.coarse_resolution" || row.name == "encoder.load.resolution" ||
         row.name == "dac.resolution" || row.name == "controller.cascade.ki";
}

TEST_F(Causes, CoverEveryParameterWithAnIdealValue) {
  std::size_t swept = 0;
  for (const parameters::Parameter& row : parameters::parameter_table()) {
    if (!row.ideal || has_a_twin(row)) continue;
    const auto found = causes_of_failures().find(row.name);
    ASSERT_NE(found, causes_of_failures().end())
        << "a study is missing in which this is the cause: " << row.name;
    ++swept;
    const Json answer = limits_with(found->second);
    const Json& limits = answer["limits"];
    EXPECT_LT(limits[0]["rate"], 0.9) << row.name;
    bool shown = false;
    for (const Json& one : limits) {
      const bool names_it = one["cause"].get<std::string>().starts_with(row.ideal->name);
      shown = shown || (names_it && one.value("shown", false) && one["rate"] > 0.9);
    }
    EXPECT_TRUE(shown) << row.name << limits;
  }
  EXPECT_EQ(swept, causes_of_failures().size());
}

// What the axis is, what is chosen, and what is asked for. A parameter that is neither here nor has an ideal
// value may cost moves and would never be named.
TEST(IdealValues, AreMissingOnlyForParametersWithoutAnIdeal) {
  const std::vector<std::string_view> without{"plant.inertia",
                                              "plant.presliding_damping",
                                              "plant.sliding_damping",
                                              "plant.load.damping",
                                              "plant.load.encoder",
                                              "plant.load.damping_to_ground",
                                              "plant.load.error.#.periods",
                                              "plant.load.error.#.pitch",
                                              "plant.load.error.#.phase",
                                              "plant.load.friction.breakaway",
                                              "plant.load.friction.stribeck_velocity",
                                              "plant.load.friction.sigma0",
                                              "plant.load.friction.sigma1",
                                              "disturbance.load.ripple.#.periods",
                                              "disturbance.load.ripple.#.pitch",
                                              "disturbance.load.ripple.#.phase",
                                              "disturbance.load.vibration.#.frequency",
                                              "disturbance.load.vibration.#.phase",
                                              "friction.model",
                                              "friction.k1",
                                              "friction.k2",
                                              "friction.beta",
                                              "friction.lambda",
                                              "friction.n",
                                              "friction.breakaway",
                                              "friction.stribeck_velocity",
                                              "friction.sigma0",
                                              "friction.sigma1",
                                              "friction.gms.attraction",
                                              "friction.gms.stiffness",
                                              "friction.gms.weight",
                                              "encoder.fine_errors.eccentricity_angle",
                                              "encoder.fine_errors.interpolation_period",
                                              "encoder.fine_errors.noise_bandwidth",
                                              "encoder.coarse_errors.eccentricity_angle",
                                              "encoder.coarse_errors.interpolation_period",
                                              "encoder.coarse_errors.noise_bandwidth",
                                              "encoder.load.fine_errors.eccentricity_angle",
                                              "encoder.load.fine_errors.interpolation_period",
                                              "encoder.load.fine_errors.noise_bandwidth",
                                              "dac.sigma_delta",
                                              "disturbance.ripple.#.periods",
                                              "disturbance.ripple.#.pitch",
                                              "disturbance.ripple.#.phase",
                                              "disturbance.vibration.#.frequency",
                                              "disturbance.vibration.#.phase"};
  const auto is_chosen = [](std::string_view name) {
    return name.starts_with("controller.") || name.starts_with("command.") || name.starts_with("initial.") ||
           name.starts_with("verdict.") || name.starts_with("friction.measured.");
  };
  for (const parameters::Parameter& row : parameters::parameter_table()) {
    const bool known = std::ranges::find(without, row.name) != without.end();
    EXPECT_TRUE(row.ideal.has_value() != known || is_chosen(row.name)) << row.name;
    if (row.ideal && row.ideal->value) {
      EXPECT_TRUE(row.none == row.ideal->value || numerics::contains(row.range, *row.ideal->value))
          << row.name;
    }
  }
}

// A spectrum is no parameter of the table, and neither is friction that varies.
TEST_F(Causes, IncludeSpectraAndVaryingFriction) {
  const auto is_shown = [](const Json& answer, std::string_view cause) {
    return std::ranges::any_of(answer["limits"], [&](const Json& one) {
      return one["cause"] == cause && one.value("shown", false);
    });
  };
  EXPECT_TRUE(
      is_shown(limits_with({"disturbance.vibration=[{spectrum: [[1, 1.0e-2], [100, 1.0e-2]], lines: 5}]"}),
               "no vibration of spectrum 0"));
}

// Where nothing that is tried helps no cause is named, and the answer says what was tried and what was not.
// Nothing that is missed everywhere can get worse: no effect "costs at most 1 %" there.
TEST_F(Causes, AreNotNamedIfNothingHelps) {
  const Json answer = limits_with({"goal.within=0.005"});
  for (const Json& one : answer["limits"]) EXPECT_FALSE(one.value("shown", false)) << one;
  const std::string headline = answer["headline"];
  EXPECT_TRUE(says(headline, "no cause of failures is shown"));
  const std::string text = program({"limits", "axis.yaml", "--set", "goal.within=0.005"}).out;
  EXPECT_TRUE(says(text, "not tried: other values of plant, friction"));
  ASSERT_EQ(answer["limits"][0]["rate"], 0.0);
  for (const Json& one : answer["additions"]) {
    EXPECT_TRUE(one["rate"].is_null()) << one;
    EXPECT_TRUE(says(one["note"].get<std::string>(), "nothing can be lost")) << one;
  }
}

// The rate before and after is that of one goal.
TEST_F(Causes, AreRankedWithinOneGoal) {
  std::string two_goals = faultless_axis;
  two_goals.replace(two_goals.find("goal:"), std::string::npos,
                    "goals: {close: {band: 2, within: 0.2, moves: 0.9},\n"
                    "        soon: {band: 350, within: 0.02, moves: 0.5}}\n");
  folder_.write("axis.yaml", two_goals);
  const ProgramResult result =
      program({"limits", "axis.yaml", "--set", "encoder.fine_errors.noise=2", "--format", "json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json answer = Json::parse(result.out);
  const std::string headline = answer["headline"];
  EXPECT_EQ(headline.find("0 % of the moves meet the goal 'close'; with no encoder noise 100 %"), 0U)
      << headline;
}

// A budget takes fewer machines, and says so.
TEST_F(Causes, UseTheBudgetOfTrials) {
  folder_.write("axis.yaml", faultless_axis);
  const Words words{"limits", "axis.yaml", "--set", "trials=5000", "--set", "encoder.fine_errors.noise=2"};
  Words few = words;
  few.insert(few.end(), {"--budget", "2000"});
  const ProgramResult result = program(few);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(says(result.out, "of 5000 trials of the study", "with no encoder noise 100 %"));
  few.back() = "100";
  const ProgramResult too_few = program(few);
  EXPECT_EQ(too_few.code, 2);
  EXPECT_TRUE(says(too_few.err, "option '--budget': "));
}

}  // namespace
}  // namespace zerocount::testing
