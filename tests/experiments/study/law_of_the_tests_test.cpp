// A whole trial in closed loop with a friction law that only the tests know, from the text of a manifest.
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "core/theory/sampled_stability.hpp"
#include "core/trial/trial_of.hpp"
#include "tests/core/friction/spring_damper.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount {
namespace {

/// The laws of the program, with that of the tests as the one which manifests call presliding.
using LawsOfTheTests = LawList<SpringDamper, SpringFriction, CoulombFriction, NoFriction>;

TrialParameters first_trial(const std::string& more) {
  const Study study = study_of(manifest_commanding("{targets: [20], hold: 0.5}", more));
  return study_trial(study, 0, 0).parameters;
}

TrialOutcome run(const TrialParameters& parameters, std::vector<SampleRecord>& records) {
  return run_trial_of<PlantOf<LawsOfTheTests>>(
      parameters, {.sample = [&](const SampleRecord& record) { records.push_back(record); }, .jerk = {}});
}

TEST(ALawOfTheTests, RunsATrialInClosedLoopFromAManifest) {
  const TrialParameters p = first_trial("controller: {ki: 2.0e-5}\nfriction: {k1: 200}\ndac: {bits: 16}\n");
  std::vector<SampleRecord> records;
  const TrialOutcome outcome = run(p, records);
  const MoveOutcome& move = outcome.moves.at(0);
  EXPECT_EQ(records.size(), 1000U);
  EXPECT_EQ(move.outcome, Outcome::zero_count);
  EXPECT_FALSE(move.broke_away);
  // At rest the torque that is held is that of the spring.
  EXPECT_NEAR(move.final_position, move.holding_torque / 200.0, 1e-9);
  // The error dies out with the time constant of the linear loop.
  const double tau = slowest_time_constant(200.0, p.plant, p.encoder, p.controller);
  EXPECT_GT(move.settling_time, 1.5 * tau);
  EXPECT_LT(move.settling_time, 6.0 * tau);
}

TEST(ALawOfTheTests, IsUnstableBeyondTheBoundOfItsStiffness) {
  for (const double factor : {0.5, 1.5}) {
    TrialParameters p = first_trial("friction: {k1: 200}\n");
    p.controller.ki = factor * sampled_critical_integral_gain(200.0, p.plant, p.encoder, p.controller);
    std::vector<SampleRecord> records;
    EXPECT_EQ(run(p, records).moves.at(0).stable, factor < 1.0);
  }
}

TEST(ALawOfTheTests, LeavesTheOthersAlone) {
  for (const std::string model : {"spring", "coulomb", "none"}) {
    const TrialParameters p = first_trial("friction: {model: " + model + "}\n");
    std::vector<SampleRecord> records;
    EXPECT_EQ(run(p, records).moves.at(0).final_position, run_trial(p).moves.at(0).final_position) << model;
  }
}

}  // namespace
}  // namespace zerocount
