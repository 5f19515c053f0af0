// The range of the converter gives its resolution, in every trial and with every word length.
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::study {
namespace {

TEST(ConverterRange, GivesTheResolutionOfEveryTrial) {
  const Study study =
      study_of(minimal_manifest("dac: {bits: {integers: [1, 32]}, range: {log_uniform: [1.0e-3, 1.0e+3]}}\n"),
               {"trials=500"});
  const std::size_t range = column_of(study, "dac.range");
  for (std::int64_t index = 0; index < study.trials; ++index) {
    const StudyTrial trial = study_trial(study, 0, index);
    const loop::DacParameters& dac = trial.parameters.dac;
    EXPECT_DOUBLE_EQ(dac.resolution, trial.inputs[range] / std::pow(2.0, dac.bits - 1)) << index;
    EXPECT_EQ(commanded_trial(study, 0, index).parameters.dac.resolution, dac.resolution) << index;
  }
  EXPECT_EQ(study.columns.inputs[range].unit, "N m");
}

// Random numbers in both forms.
TEST(ConverterRange, IsAnotherWayToWriteTheSameConverter) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 200; ++i) {
    const int bits = std::uniform_int_distribution<int>(1, 32)(random);
    const double range = std::exp(std::uniform_real_distribution(-9.0, 9.0)(random));
    const double resolution = std::ldexp(range, 1 - bits);
    const auto of = [&](const std::string& key, double value) {
      const Study study =
          study_of(minimal_manifest(fmt::format("dac: {{bits: {}, {}: {:.17g}}}\n", bits, key, value)));
      return study_trial(study, 0, 0).parameters.dac.resolution;
    };
    EXPECT_EQ(of("range", range), of("resolution", resolution));
  }
}

TEST(ConverterRange, StaysWhileTheWordLengthIsSwept) {
  const Study study =
      study_of(minimal_manifest("dac: {range: 0.5}\nsweep: {grid: {dac.bits: [1, 8, 12, 16]}}\n"));
  for (std::int64_t point = 0; point < 4; ++point) {
    const loop::DacParameters dac = study_trial(study, point, 0).parameters.dac;
    EXPECT_EQ(dac.resolution * std::pow(2.0, dac.bits - 1), 0.5);
  }
}

TEST(ConverterRange, StandsInPlaceOfTheResolution) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("dac: {resolution: 2.4e-4, range: 0.5}\n")),
                         "6:19: dac.resolution | dac.range | either"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("dac: {range: 0}\n")),
                         "6:14: dac.range | greater than 0 | or none"));
  EXPECT_EQ(refusal_of(minimal_manifest("dac: {resolution: 2.4e-4, range: none}\n")), "");
  // Each has an effect at one of the points.
  EXPECT_EQ(refusal_of(minimal_manifest(
                "sweep: {cases: {a: {dac.resolution: 1.0e-4}, b: {dac.range: {uniform: [0.4, 0.5]}}}}\n")),
            "");
  EXPECT_TRUE(
      has_faults(study_of(manifest_commanding("{torque: {levels: [0.4]}}", "dac: {range: 0.3}\n")).warnings,
                 "5:29: command.torque.levels.0 | clipped"));
}

// Without it the resolution of a linear axis is required, because its default is in N m.
TEST(ConverterRange, IsEnoughOnALinearAxis) {
  const auto linear = [](const std::string& dac) {
    return manifest_commanding("{torque: {levels: [0], rate: 1}}",
                               "axis: linear\nencoder: {resolution: 1.0e-9}\n"
                               "plant: {inertia: 5, sliding_damping: 0, presliding_damping: 0}\n"
                               "friction: {model: none}\n" +
                                   dac);
  };
  EXPECT_EQ(refusal_of(linear("dac: {range: 100}\n")), "");
  EXPECT_NE(refusal_of(linear("dac: {bits: 16}\n")).find("dac.resolution"), std::string::npos);
}

}  // namespace
}  // namespace zerocount::study
