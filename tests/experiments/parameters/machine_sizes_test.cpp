// The same keys serve a galvanometer, a slide of half a tonne and a telescope: no range is that of one size.
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/study/study.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount {
namespace {

/// The size of a machine. The numbers of its manifest are of the order of these.
struct Machine {
  std::string_view name;
  std::string_view axis;
  std::string_view encoder;
  double inertia;      ///< inertia, kg m², or mass, kg
  double move;         ///< length of a move, rad or m
  double bandwidth;    ///< bandwidth of the loop, rad/s
  double sample_rate;  ///< sample rate, Hz

  double torque() const { return inertia * move * bandwidth * bandwidth; }
};

constexpr Machine machines[]{
    {"slide", "linear", "resolution: 1.0e-7", 500, 1e-3, 200, 4000},
    {"telescope", "rotary", "fine: 100000000, coarse: 100000000", 6e6, 1e-3, 10, 200},
    {"galvanometer", "rotary", "fine: 10000000, coarse: 10000000", 1e-9, 1e-3, 2e4, 400e3},
};

/// For each unit, the number that is typical for a machine of this size.
std::map<std::string_view, double> scales_of(const Machine& m) {
  const double stiffness = m.torque() / m.move;
  return {
      {"kg m^2", m.inertia},
      {"N m", m.torque()},
      {"rad", m.move},
      {"s", 1.0 / m.bandwidth},
      {"Hz", m.bandwidth},
      {"1/s", m.bandwidth},
      {"rad/s", m.move * m.bandwidth},
      {"rad/s^2", m.torque() / m.inertia},
      {"rad/s^3", m.torque() / m.inertia * m.bandwidth},
      {"1/rad", 1.0 / m.move},
      {"N m/s", m.torque() * m.bandwidth},
      {"N m/rad", stiffness},
      {"N m/(rad s)", stiffness * m.bandwidth},
      {"N m s/rad", stiffness / m.bandwidth},
      {"N m s^2/rad", m.inertia},
      {"N m/count", m.torque()},
      {"(N m)^n/rad", m.torque() * m.torque() / m.move},
  };
}

TEST(MachineSizes, EveryRangeHoldsTheNumbersOfEveryMachine) {
  for (const Machine& machine : machines) {
    const std::map<std::string_view, double> scales = scales_of(machine);
    int rows = 0;
    for (const parameters::Parameter& row : parameters::parameter_table()) {
      for (const std::string_view unit : {row.unit, row.si_unit}) {
        const auto scale = scales.find(unit);
        if (scale == scales.end()) continue;
        ++rows;
        for (const double factor : {1e-3, 1.0, 1e3})
          EXPECT_TRUE(numerics::contains(row.range, factor * scale->second))
              << machine.name << ": " << row.name << ": " << factor * scale->second << " " << unit;
      }
    }
    EXPECT_GT(rows, 80);
  }
}

/// Manifest of a cascade control with everything that depends on the size of the machine.
/// @param gain factor of the velocity loop's gains
std::string manifest_of(const Machine& m, double gain = 1.0) {
  const double stiffness = m.torque() / m.move;
  const double damping = stiffness / m.bandwidth;
  return fmt::format(
      "zerocount: 1\nname: {}\naxis: {}\nseed: 1\ntrials: 2\n"
      "plant: {{inertia: {:.6e}, sliding_damping: {:.6e}, load: {{inertia: {:.6e}, stiffness: {:.6e}, "
      "damping: {:.6e}}}}}\n"
      "friction: {{model: lugre, sigma0: {:.6e}, sigma1: {:.6e}, breakaway: {:.6e}, coulomb_ratio: 0.8, "
      "stribeck_velocity: {:.6e}}}\n"
      "encoder: {{{}}}\ndac: {{bits: 20, range: {:.6e}}}\n"
      "controller: {{structure: cascade, cascade: {{kv: {:.6e}, kp: {:.6e}, ki: {:.6e}}}, sample_rate: {}, "
      "delay: 1, feedforward: {{velocity: {:.6e}, acceleration: {:.6e}, friction: {:.6e}}}, "
      "observer: {{bandwidth: {:.6e}, inertia: {:.6e}}}}}\n"
      "disturbance: {{torque: {:.6e}}}\nverdict: {{dwell: {:.6e}, window: {:.6e}}}\n"
      "command: {{units: si, targets: [{:.6e}], hold: {:.6e}, profile: {{shape: s_curve, velocity_limit: "
      "{:.6e}, acceleration_limit: {:.6e}, jerk_limit: {:.6e}}}}}\n",
      m.name, m.axis, m.inertia, 0.01 * damping, 0.1 * m.inertia, 100.0 * stiffness, 0.1 * damping,
      30.0 * stiffness, damping, 0.05 * m.torque(), 0.01 * m.move * m.bandwidth, m.encoder, m.torque(),
      0.3 * m.bandwidth, gain * damping, gain * 0.3 * stiffness, m.sample_rate, 0.01 * damping, m.inertia,
      0.03 * m.torque(), 0.1 * m.bandwidth, m.inertia, 0.01 * m.torque(), 5.0 / m.bandwidth,
      5.0 / m.bandwidth, m.move, 200.0 / m.bandwidth, m.move * m.bandwidth, 0.5 * m.torque() / m.inertia,
      m.torque() / m.inertia * m.bandwidth);
}

TEST(MachineSizes, AManifestOfEachIsAcceptedWithoutAWarning) {
  for (const Machine& machine : machines) {
    const study::Study study = study_of(manifest_of(machine));
    EXPECT_TRUE(study.warnings.empty()) << machine.name << ": " << study.warnings.front();
  }
}

TEST(MachineSizes, AbsurdNumbersGiveAWarningAndImpossibleOnesAreRefused) {
  for (const Machine& machine : machines) {
    const std::vector<std::string> warnings = study_of(manifest_of(machine, 1e5)).warnings;
    ASSERT_EQ(warnings.size(), 1U) << machine.name;
    EXPECT_TRUE(says(warnings[0], "controller.cascade.kp: one count of error commands"));
    for (const char* key : {"controller.cascade.kp", "controller.cascade.ki", "controller.kp",
                            "controller.feedforward.acceleration", "controller.standstill.ki"}) {
      for (const char* value : {"1.0e+16", "-1"})
        EXPECT_NE(refusal_of(manifest_of(machine), {fmt::format("{}={}", key, value)}), "") << key << value;
    }
  }
}

}  // namespace
}  // namespace zerocount

// One table has the units of both kinds of axes: those of a linear axis follow from the rotary ones.

namespace zerocount::parameters {
namespace {

TEST(StudyUnits, ALinearAxisHasForceAndPosition) {
  const std::array<std::array<std::string, 2>, 15> units{{{"rad", "m"},
                                                          {"N m", "N"},
                                                          {"(N m)", "(N)"},
                                                          {"kg m^2", "kg"},
                                                          {"N m/rad", "N/m"},
                                                          {"N m s/rad", "N s/m"},
                                                          {"N m/(rad s)", "N/(m s)"},
                                                          {"(N m)^n/rad", "N^n/m"},
                                                          {"1/rad", "1/m"},
                                                          {"rad/s^2", "m/s^2"},
                                                          {"N m/count", "N/count"},
                                                          {"µrad", "µm"},
                                                          {"arcsec", "µm"},
                                                          {"s", "s"},
                                                          {"count/sample", "count/sample"}}};
  for (const auto& [rotary, linear] : units) {
    EXPECT_EQ(unit_on(AxisKind::rotary, rotary), rotary);
    EXPECT_EQ(unit_on(AxisKind::linear, rotary), linear);
    EXPECT_EQ(unit_on(AxisKind::linear, linear), linear) << "a unit of a linear axis stays as it is";
  }
}

TEST(StudyUnits, TextsOfALinearAxisNeverMentionRotation) {
  for (const GainUnits gains : {GainUnits::count, GainUnits::si}) {
    const StudyUnits units{AxisKind::linear, gains};
    for (const Parameter& parameter : parameter_table()) {
      if (!exists_on(parameter, AxisKind::linear)) continue;
      const std::string text = unit_of(parameter, units) + ": " + meaning_of(parameter, units);
      for (const char* word : {"rad", "N m", "kg m", "rotor", "torque", "angle", "revolution", "$"})
        EXPECT_FALSE(says(text, word)) << parameter.name << ": " << text;
    }
  }
}

TEST(StudyUnits, PlaceholdersBecomeTheWordsOfTheAxis) {
  const char* const text =
      "$torque of command.torque.levels at a $rotor_angle of the $rotor along the $track";
  EXPECT_EQ(text_on(AxisKind::rotary, text),
            "torque of command.torque.levels at a rotor angle of the rotor along the rotor");
  EXPECT_EQ(text_on(AxisKind::linear, text),
            "force of command.torque.levels at a position of the slide along the travel");
}

// What is in other units than the default's has to be given.
TEST(StudyUnits, ADefaultAppliesOnlyInItsOwnUnits) {
  const auto holds = [](const char* name, const StudyUnits& units) {
    return default_holds(parameter_table()[find_parameter(name).value()], units);
  };
  const StudyUnits rotary, si{AxisKind::rotary, GainUnits::si}, linear{AxisKind::linear};
  for (const char* name : {"plant.inertia", "friction.k1", "controller.ki", "dac.resolution"}) {
    EXPECT_TRUE(holds(name, rotary)) << name;
    EXPECT_FALSE(holds(name, linear)) << name;
  }
  EXPECT_FALSE(holds("controller.ki", si));
  EXPECT_TRUE(holds("controller.kp", si)) << "0 is 0 in any unit";
  EXPECT_TRUE(holds("plant.inertia", si));
  EXPECT_TRUE(holds("friction.alpha", linear)) << "1/s";
  EXPECT_TRUE(holds("friction.model", linear));
  EXPECT_FALSE(holds("encoder.resolution", linear));
}

}  // namespace
}  // namespace zerocount::parameters
