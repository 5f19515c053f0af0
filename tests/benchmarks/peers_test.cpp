// The peers run the same trials as the reference: otherwise the benchmarks would compare unlike things.
#include "tests/benchmarks/peers/peers.hpp"

#include <algorithm>
#include <iostream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "experiments/study/study_trial.hpp"
#include "tests/benchmarks/peer_agreement.hpp"
#include "tests/benchmarks/workloads.hpp"

namespace zerocount::testing {
namespace {

/// A few trials of one kind that the benchmarks time, to check the other libraries' integrators quickly.
struct Sight {
  std::string manifest;
  std::int64_t calm_trials;
};

const std::vector<Sight> sights{{"bench-transient", 60}, {"bench-creep", 6}, {"bench-marginal", 12}};

TEST(BenchmarkPeers, AgreeWithTheReferenceSampleBySample) {
  for (const Peer& peer : all_peers()) {
    for (const Sight& sight : sights) {
      const EngineAgreement agreement =
          agreement_with_reference(peer.record, workload_study(sight.manifest), sight.calm_trials);
      std::cout << peer.name << ", " << sight.manifest << ": " << agreement.text() << "\n";
      EXPECT_TRUE(agreement.holds()) << peer.name << ", " << sight.manifest;
      EXPECT_EQ(agreement.calm_trials, sight.calm_trials);
    }
  }
}

TEST(BenchmarkPeers, HaveTheMeasuresOfTheReference) {
  for (const Peer& peer : all_peers()) {
    for (const Sight& sight : sights) {
      const study::Study study = workload_study(sight.manifest);
      for (std::int64_t index = 0; index < sight.calm_trials; ++index) {
        const trial::TrialParameters parameters = study::study_trial(study, 0, index).parameters;
        const trial::MoveOutcome expected = trial::run_trial(parameters).moves.at(0);
        const trial::MoveOutcome found = peer.run(parameters).moves.at(0);
        EXPECT_EQ(found.broke_away, expected.broke_away) << peer.name << " " << index;
        if (expected.broke_away) continue;
        EXPECT_EQ(found.outcome, expected.outcome) << peer.name << " " << index;
        EXPECT_EQ(found.arrival, expected.arrival) << peer.name << " " << index;
        EXPECT_EQ(found.overshoot, expected.overshoot) << peer.name << " " << index;
        EXPECT_EQ(found.jerk_count, expected.jerk_count) << peer.name << " " << index;
        EXPECT_EQ(found.holding_torque, expected.holding_torque) << peer.name << " " << index;
        EXPECT_NEAR(found.creep, expected.creep, 4e-12) << peer.name << " " << index;
      }
    }
  }
}

// After a breakaway the trials part, but not what becomes of them.
TEST(BenchmarkPeers, BreakAwayAsOftenAndOscillateAlike) {
  const study::Study study = workload_study("bench-marginal");
  for (const Peer& peer : all_peers()) {
    int oscillating = 0;
    int expected = 0;
    double peak = 0.0;
    double expected_peak = 0.0;
    constexpr int trials = 60;
    for (int index = 0; index < trials; ++index) {
      const trial::TrialParameters parameters = study::study_trial(study, 0, index).parameters;
      const trial::MoveOutcome reference = trial::run_trial(parameters).moves.at(0);
      const trial::MoveOutcome found = peer.run(parameters).moves.at(0);
      oscillating += found.outcome == trial::Outcome::oscillating;
      expected += reference.outcome == trial::Outcome::oscillating;
      peak += found.peak_torque / trials;
      expected_peak += reference.peak_torque / trials;
    }
    EXPECT_NEAR(oscillating, expected, 2) << peer.name;
    EXPECT_GT(expected, trials / 2);
    EXPECT_NEAR(peak / expected_peak, 1.0, 0.02) << peer.name;
  }
}

// Moves one after the other, a delay and the other gains are in the loop too.
TEST(BenchmarkPeers, CoverTheWholePlainLoop) {
  const study::Study study = workload_study(
      "bench-transient", {"controller.kp=3.0e-4", "controller.kd=1.0e-4", "controller.delay=1",
                          "controller.ki=2.0e-5", "initial.preload=-0.1", "initial.hardening=1.0e-6"});
  for (const Peer& peer : all_peers()) {
    Agreement total;
    for (std::int64_t index = 0; index < 20; ++index) {
      trial::TrialParameters parameters = study::study_trial(study, 0, index).parameters;
      parameters.command.targets.insert(parameters.command.targets.end(), {-3, 4, 0});
      total.add(compare(parameters, peer.record(parameters), reference_records(parameters), peer.name));
    }
    for (const std::string& failure : total.failures) ADD_FAILURE() << failure;
    EXPECT_GT(total.samples, 20000);
  }
}

TEST(BenchmarkPeers, RefuseUnsupportedFeatures) {
  trial::TrialParameters parameters = study::study_trial(workload_study("bench-transient"), 0, 0).parameters;
  parameters.amplifier.bandwidth = 500.0;
  for (const Peer& peer : all_peers()) EXPECT_THROW(peer.run(parameters), std::invalid_argument);
}

// A peer that is not exact enough, or that has other trials, does not get as far as being timed.
TEST(EngineAgreement, FailsForAnEngineThatDoesNotAgree) {
  const study::Study study = workload_study("bench-transient");
  const Peer coarse = odeint_peer(1e-9);
  EXPECT_FALSE(agreement_with_reference(coarse.record, study, 20).holds());
  const auto other_phase = [](trial::TrialParameters parameters) {
    parameters.initial.encoder_phase *= 0.5;
    return reference_records(parameters);
  };
  EXPECT_FALSE(agreement_with_reference(other_phase, study, 20).holds());
  EXPECT_TRUE(agreement_with_reference(reference_records, study, 20).holds());
}

}  // namespace
}  // namespace zerocount::testing
