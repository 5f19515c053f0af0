// The identified axis simulated under the recorded force, without a restart, and what the unexplained force
// repeats with.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "analysis/record/sliding_identification/sliding_identification.hpp"
#include "tests/analysis/record/sliding_identification/records.hpp"

namespace zerocount::testing {
namespace {

using sliding_identification::FreeRun;
using sliding_identification::RepeatingForce;
using sliding_identification::SlidingIdentification;

SlidingIdentification identify(const records::RawSeries& series) {
  return sliding_identification::identify_sliding({sliding_identification::sliding_record(series)});
}

double predicted_by(const SlidingIdentification& found, const std::string& with) {
  return std::ranges::find(found.forces, with, &RepeatingForce::with)->predicted;
}

// Where the law is that of the axis only the errors of its parameters add up.
TEST(FreeRunOfTheAxis, FollowsAnAxisWithTheSameLaw) {
  std::mt19937_64 random(11);
  const records::RawSeries series = closed_loop_record({}, {}, emps_lap(), 2, random);
  const SlidingIdentification found = identify(series);
  ASSERT_EQ(found.runs.size(), 1u);
  const FreeRun& run = found.runs[0];
  const auto [lowest, highest] = std::ranges::minmax(series.angle);
  EXPECT_NEAR(run.stroke, highest - lowest, 1e-12);
  EXPECT_LT(run.start, 0.1);
  EXPECT_NEAR(run.start + run.duration, series.time.back(), 1e-9);
  EXPECT_LT(run.rms, 2e-4 * run.stroke);
  EXPECT_GE(run.max, run.rms);
}

// Dwells under a positioning loop, bristles before sliding and noise, by another integrator: the rotor rests
// where the friction holds it, so that the error does not grow from dwell to dwell.
TEST(FreeRunOfTheAxis, StandsStillInDwells) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    std::mt19937_64 random(seed);
    DwellLoop loop;
    loop.noise = 5e-8;
    const SlidingIdentification found = identify(dwell_record({}, loop, random));
    EXPECT_LT(found.runs[0].rms, 0.02 * found.runs[0].stroke) << seed;
    EXPECT_GT(found.runs[0].duration, 8.0);
  }
}

// A wrong force of ΔF moves a sliding axis by ΔF/cs each second.
TEST(FreeRunOfTheAxis, DriftsIfTheLawLacksAForce) {
  std::mt19937_64 random(12);
  SlidingAxis shaken;
  shaken.friction_noise = 1.0;
  const SlidingIdentification with = identify(closed_loop_record(shaken, {}, emps_lap(), 2, random));
  const SlidingIdentification without = identify(closed_loop_record({}, {}, emps_lap(), 2, random));
  EXPECT_GT(with.runs[0].rms, 10.0 * without.runs[0].rms);
}

/// A record with an additional force that depends on the position and is larger in one direction of travel
/// than in the other.
records::RawSeries with_force_along_travel(double amplitude, double direction_part, std::mt19937_64& random) {
  records::RawSeries series = closed_loop_record({}, {}, emps_lap(), 2, random);
  const auto [lowest, highest] = std::ranges::minmax(series.angle);
  for (std::size_t k = 0; k + 1 < series.angle.size(); ++k) {
    const double part = (series.angle[k] - lowest) / (highest - lowest);
    const double direction = series.angle[k + 1] >= series.angle[k] ? 1.0 : -1.0;
    series.torque[k] +=
        amplitude * std::sin(4.0 * std::numbers::pi * part) * (1.0 + direction_part * direction);
  }
  return series;
}

TEST(UnexplainedForce, RepeatsWithThePosition) {
  std::mt19937_64 random(13);
  const SlidingIdentification found = identify(with_force_along_travel(2.0, 0.0, random));
  EXPECT_GT(predicted_by(found, "position"), 0.7);
  EXPECT_NE(reason_of_distrust(found), "");
  EXPECT_GT(predicted_by(found, "position and direction"), 0.7);
  EXPECT_LT(predicted_by(found, "acceleration"), 0.3);
  const auto& force = *std::ranges::find(found.forces, std::string("position"), &RepeatingForce::with);
  EXPECT_NEAR(force.high, 2.0, 0.4);
  EXPECT_NEAR(force.low, -2.0, 0.4);
}

TEST(UnexplainedForce, RepeatsWithPositionAndDirection) {
  std::mt19937_64 random(14);
  const SlidingIdentification found = identify(with_force_along_travel(1.5, 1.0, random));
  EXPECT_GT(predicted_by(found, "position and direction"), predicted_by(found, "position") + 0.2);
}

TEST(UnexplainedForce, ARandomForceRepeatsWithNothing) {
  std::mt19937_64 random(15);
  SlidingAxis shaken;
  shaken.friction_noise = 1.0;
  const SlidingIdentification found = identify(closed_loop_record(shaken, {}, emps_lap(), 2, random));
  for (const RepeatingForce& force : found.forces) EXPECT_LT(force.predicted, 0.15) << force.with;
}

TEST(UnexplainedForce, NeedsSeveralStrokes) {
  std::mt19937_64 random(16);
  const SlidingIdentification found = identify(closed_loop_record({}, {}, {{0.1228, 0.6}}, 1, random));
  EXPECT_TRUE(found.forces.empty());
  EXPECT_TRUE(found.one_direction);
  EXPECT_NE(reason_of_distrust(found), "");
  const auto json = document::json(sliding_identification::sliding_answer().of(found));
  EXPECT_EQ(json["unexplained"].size(), 0u);
  EXPECT_NEAR(json["simulation"][0]["proportion"].get<double>(), found.runs[0].rms / found.runs[0].stroke,
              1e-15);
  SlidingAxis cogged;
  cogged.ripple = {{2.0, 600.0, 0.3}};
  EXPECT_NE(reason_of_distrust(identify(closed_loop_record(cogged, {}, {{0.1228, 0.6}}, 1, random))), "");
}

// After a reversal Dahl's friction is Fc·(1 − 2·exp(−σ0·x/Fc)): nine tenths of 2·Fc are done at ln 10·Fc/σ0.
TEST(FrictionReversal, HasTheTravelOfTheBristles) {
  for (const double travel : {60e-6, 150e-6}) {
    std::mt19937_64 random(17);
    SlidingAxis axis;
    axis.bristle_stiffness = std::numbers::ln10 * axis.coulomb / travel;
    const SlidingIdentification found = identify(closed_loop_record(axis, {}, emps_lap(), 2, random));
    ASSERT_TRUE(found.reversal.has_value());
    EXPECT_EQ(found.reversal->reversals.size(), 3u);
    EXPECT_GE(found.reversal->samples, sliding_identification::min_reversal_samples);
    EXPECT_NEAR(found.reversal->travel, travel, 0.3 * travel);
    EXPECT_NEAR(found.reversal->swing, 2.0 * axis.coulomb, 0.1 * axis.coulomb);
    EXPECT_NEAR(found.reversal->stiffness, 0.9 * found.reversal->swing / found.reversal->travel, 1e-6);
  }
}

TEST(FrictionReversal, AnAbruptReversalIsNotReported) {
  std::mt19937_64 random(18);
  const SlidingIdentification found = identify(closed_loop_record({}, {}, emps_lap(), 2, random));
  ASSERT_TRUE(found.reversal.has_value());
  EXPECT_LT(found.reversal->samples, sliding_identification::min_reversal_samples);
}

}  // namespace
}  // namespace zerocount::testing
