// A whole trial in closed loop with a friction law that only the tests know, from the text of a manifest.
#include "core/theory/sampled_stability.hpp"
#include "core/trial/trial_of.hpp"
#include "tests/core/friction/spring_damper.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::study {
namespace {

/// The laws of the program, with that of the tests as the one which manifests call presliding.
using LawsOfTheTests = friction::LawList<SpringDamper, friction::SpringFriction, friction::CoulombFriction,
                                         friction::NoFriction>;

trial::TrialParameters first_trial(const std::string& more) {
  const Study study = study_of(manifest_commanding("{targets: [20], hold: 0.5}", more));
  return study_trial(study, 0, 0).parameters;
}

trial::TrialOutcome run(const trial::TrialParameters& parameters, std::vector<trial::SampleRecord>& records) {
  return trial::run_trial_of<plant::PlantOf<LawsOfTheTests>>(
      parameters,
      {.sample = [&](const trial::SampleRecord& record) { records.push_back(record); }, .jerk = {}});
}

TEST(ALawOfTheTests, RunsATrialInClosedLoopFromAManifest) {
  const trial::TrialParameters p =
      first_trial("controller: {ki: 2.0e-5}\nfriction: {k1: 200}\ndac: {bits: 16}\n");
  std::vector<trial::SampleRecord> records;
  const trial::TrialOutcome outcome = run(p, records);
  const trial::MoveOutcome& move = outcome.moves.at(0);
  EXPECT_EQ(records.size(), 1000U);
  EXPECT_EQ(move.outcome, trial::Outcome::zero_count);
  EXPECT_FALSE(move.broke_away);
  // At rest the torque that is held is that of the spring.
  EXPECT_NEAR(move.final_position, move.holding_torque / 200.0, 1e-9);
  // The error dies out with the time constant of the linear loop.
  const double tau = theory::slowest_time_constant(200.0, p.plant, p.encoder, p.controller);
  EXPECT_GT(move.settling_time, 1.5 * tau);
  EXPECT_LT(move.settling_time, 6.0 * tau);
}

TEST(ALawOfTheTests, IsUnstableBeyondTheBoundOfItsStiffness) {
  for (const double factor : {0.5, 1.5}) {
    trial::TrialParameters p = first_trial("friction: {k1: 200}\n");
    p.controller.ki =
        factor * theory::sampled_critical_integral_gain(200.0, p.plant, p.encoder, p.controller);
    std::vector<trial::SampleRecord> records;
    EXPECT_EQ(run(p, records).moves.at(0).stable, factor < 1.0);
  }
}

TEST(ALawOfTheTests, LeavesTheOthersAlone) {
  for (const std::string model : {"spring", "coulomb", "none"}) {
    const trial::TrialParameters p = first_trial("friction: {model: " + model + "}\n");
    std::vector<trial::SampleRecord> records;
    EXPECT_EQ(run(p, records).moves.at(0).final_position, trial::run_trial(p).moves.at(0).final_position)
        << model;
  }
}

}  // namespace
}  // namespace zerocount::study
