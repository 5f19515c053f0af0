// One table has the units of both kinds of axes: those of a linear axis follow from the rotary ones.
#include "experiments/parameters/study_units.hpp"

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::parameters {
namespace {

TEST(StudyUnits, ForceAndPositionStandForTorqueAndAngle) {
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

TEST(StudyUnits, NoUnitOrMeaningOfALinearAxisSpeaksOfRotation) {
  for (const GainUnits gains : {GainUnits::count, GainUnits::si}) {
    const StudyUnits units{AxisKind::linear, gains};
    for (const Parameter& parameter : parameter_table()) {
      if (!exists_on(parameter, AxisKind::linear)) continue;
      const std::string text = unit_of(parameter, units) + ": " + meaning_of(parameter, units);
      for (const char* word : {"rad", "N m", "kg m", "rotor", "torque", "angle", "revolution", "$"}) {
        EXPECT_EQ(text.find(word), std::string::npos) << parameter.name << ": " << text;
      }
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
TEST(StudyUnits, ADefaultHoldsInItsOwnUnitsAlone) {
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
