// Gains in SI units are those of the continuous control: every trial has the same one, whatever its sample
// rate and its encoder.
#include <string>

#include <gtest/gtest.h>

#include "core/theory/gains.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::study {
namespace {

void expect_gain(double gain, double expected) {
  EXPECT_NEAR(gain, expected, 4e-16 * expected);
}

// kp·Δx, ki·Δx·T/2 and kd·Δx/T of each trial.
TEST(GainUnits, AreConvertedWithTheSampleTimeAndTheCountOfTheTrial) {
  const Study study =
      study_of(minimal_manifest(
                   "encoder: {fine: {integers: [100000, 5000000]}, coarse: 86400}\n"
                   "controller: {units: si, sample_rate: {uniform: [500, 20000]}, kp: {uniform: [0, 200]},\n"
                   "  ki: {log_uniform: [1.0e+3, 1.0e+6]}, encoder: coarse,\n"
                   "  coarse: {coarse_beyond: 1000, kp: 100, ki: 2.0e+3, kd: 0.5, encoder: coarse}}\n"
                   "sweep: {grid: {dac.bits: [12, 16]}}\n"),
               {"trials=300"});
  const std::size_t kp = column_of(study, "controller.kp");
  const std::size_t ki = column_of(study, "controller.ki");
  EXPECT_EQ(study.columns.inputs[kp].unit, "N m/rad");
  EXPECT_EQ(study.columns.inputs[ki].unit, "N m/(rad s)");
  for (std::int64_t index = 0; index < study.trials; ++index) {
    const StudyTrial trial = study_trial(study, 1, index);
    const loop::ControllerParameters& c = trial.parameters.controller;
    // Both phases are fed back from the coarse encoder, whose counts are taken in fine ones.
    const double count = 2.0 * 3.14159265358979323846 / trial.parameters.encoder.fine;
    const double T = 1.0 / c.sample_rate;
    expect_gain(c.kp, trial.inputs[kp] * count);
    expect_gain(c.ki, trial.inputs[ki] * count * T / 2.0);
    EXPECT_EQ(c.kd, 0.0);
    expect_gain(c.coarse.kp, 100.0 * count);
    expect_gain(c.coarse.ki, 2.0e3 * count * T / 2.0);
    expect_gain(c.coarse.kd, 0.5 * count / T);
  }
}

TEST(GainUnits, AreTheSameContinuousControlAtEveryPointOfASweep) {
  const Study study = study_of(minimal_manifest(
      "controller: {units: si, kp: 10, ki: 4.0e+4, kd: 0.02}\n"
      "sweep: {grid: {controller.sample_rate: [500, 2000, 10000], encoder.fine: [36000, 1620000]}}\n"));
  ASSERT_EQ(point_count(study), 6);
  for (std::int64_t point = 0; point < 6; ++point) {
    const trial::TrialParameters p = study_trial(study, point, 0).parameters;
    const theory::AnalogueGains gains = theory::analogue_gains(p.controller, p.encoder);
    EXPECT_NEAR(gains.kp, 10.0, 1e-14);
    EXPECT_NEAR(gains.ki, 4.0e4, 1e-10);
    EXPECT_NEAR(gains.kd, 0.02, 1e-16);
  }
}

TEST(GainUnits, PerCountAreThoseOfTheManifest) {
  const StudyTrial trial = study_trial(
      study_of(minimal_manifest("controller: {units: count, kp: 1.0e-4, ki: 2.0e-5, kd: 3.0e-4}\n")), 0, 0);
  EXPECT_EQ(trial.parameters.controller.kp, 1.0e-4);
  EXPECT_EQ(trial.parameters.controller.ki, 2.0e-5);
  EXPECT_EQ(trial.parameters.controller.kd, 3.0e-4);
}

// 3.85e-5 N m/count is not 3.85e-5 N m/(rad s).
TEST(GainUnits, DoNotTakeADefaultPerCountForOneInSi) {
  const char* const missing = "1:1: controller.ki | missing";
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {units: si}\n")), missing));
  EXPECT_TRUE(has_faults(
      refusal_of(minimal_manifest("controller: {units: si}\n"
                                  "sweep: {cases: {a: {controller.ki: 1}, b: {controller.kp: 1}}}\n")),
      missing));
  EXPECT_EQ(refusal_of(minimal_manifest("controller: {units: si}\nsweep: {grid: {controller.ki: [1, 2]}}\n")),
            "");
  EXPECT_EQ(refusal_of(minimal_manifest("controller: {units: si, ki: 0}\n")), "");
  EXPECT_EQ(refusal_of(manifest_commanding("{torque: {levels: [0.1]}}", "controller: {units: si}\n")), "");
}

TEST(GainUnits, HaveAWordAndAreTheSameAtAllPoints) {
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("controller: {units: SI}\n")), "6:21: controller.units | 'SI'"));
  EXPECT_NE(refusal_of(minimal_manifest("sweep: {grid: {controller.units: [count, si]}}\n"))
                .find("this key cannot be swept"),
            std::string::npos);
}

}  // namespace
}  // namespace zerocount::study
