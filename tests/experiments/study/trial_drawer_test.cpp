// Draws with what trials share kept, beside single draws of the same trials.
#include "experiments/study/trial_drawer.hpp"

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "experiments/study/plan.hpp"
#include "experiments/study/point_edit.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/draws.hpp"

namespace zerocount::study {
namespace {

/// Inputs, targets, and all parameters that have a number.
std::vector<std::uint64_t> bits_of(const Study& study, const StudyTrial& trial) {
  std::vector<std::uint64_t> bits;
  for (const double input : trial.inputs) bits.push_back(std::bit_cast<std::uint64_t>(input));
  for (const double target : trial.target_positions) bits.push_back(std::bit_cast<std::uint64_t>(target));
  for (const std::int64_t target : trial.parameters.command.targets)
    bits.push_back(static_cast<std::uint64_t>(target));
  for (const parameters::Parameter& row : study.plan->table.rows)
    if (row.get) bits.push_back(std::bit_cast<std::uint64_t>(row.get(trial.parameters)));
  bits.push_back(trial.parameters.randomness.trial);
  bits.push_back(trial.parameters.friction.profiled.size());
  return bits;
}

/// A manifest with values of every distribution, whose spreads are random.
std::string random_spreads(testing::Draws& draws) {
  const double low = draws.log_uniform(0.01, 1.0), high = low * draws.log_uniform(1.1, 50.0);
  const double mean = draws.uniform(300.0, 900.0), sd = draws.log_uniform(1.0, 200.0);
  const double limit = mean + sd * draws.uniform(-0.5, 3.0);  // one tail, or both
  return fmt::format(
      "friction:\n"
      "  k1: {{lognormal: {{median: {}, cv: {}}}}}\n"
      "  k2: {{truncated_normal: {{mean: {}, sd: {}, low: {}, high: {}}}}}\n"
      "  beta: {{triangular: [1.0e+4, {}, 9.0e+4]}}\n"
      "  alpha: {{log_uniform: [{}, {}]}}\n"
      "  lambda: {{uniform: [{}, {}]}}\n"
      "  n: {{choice: [1.5, 2, 2.5]}}\n",
      draws.uniform(50.0, 200.0), draws.log_uniform(0.01, 1.0), mean, sd, limit,
      limit + draws.uniform(0.1, 3.0) * sd, draws.uniform(2e4, 8e4), low, high, 10.0 * low, 10.0 * high);
}

void expect_same_draws(const Study& study, TrialDrawer& drawer, StudyTrial& trial, testing::Draws& draws) {
  for (int i = 0; i < 40; ++i) {
    const std::int64_t point = draws.integer(0, point_count(study) - 1);
    const std::int64_t index = draws.integer(0, study.trials - 1);
    drawer.draw(point, index, trial);
    EXPECT_EQ(bits_of(study, trial), bits_of(study, study_trial(study, point, index)))
        << "point " << point << ", trial " << index;
    if (draws.chance(0.5)) trial.inputs = {};  // as a runner takes them away
  }
}

TEST(TrialDrawer, DrawsTheBitsOfSingleTrials) {
  testing::Draws draws(20260131);
  for (const std::string design : {"monte_carlo", "latin_hypercube", "sobol"}) {
    for (int round = 0; round < 8; ++round) {
      std::string text = random_spreads(draws);
      if (round % 2 == 1)
        text +=
            "sweep: {cases: {a: {friction.alpha: 0.5}, b: {friction.alpha: {log_uniform: [0.2, 0.7]}}}}\n";
      const Study study = study_of(minimal_manifest(text), {"trials=64", "design=" + design});
      TrialDrawer drawer(study);
      StudyTrial trial;
      expect_same_draws(study, drawer, trial, draws);
    }
  }
}

// A point that is changed has spreads of its own, in a plan of its own.
TEST(TrialDrawer, FollowsAChangedPoint) {
  testing::Draws draws(20260132);
  for (int round = 0; round < 8; ++round) {
    Study study = study_of(minimal_manifest(random_spreads(draws)), {"trials=64"});
    TrialDrawer drawer(study);
    StudyTrial trial;
    for (int change = 0; change < 4; ++change) {
      expect_same_draws(study, drawer, trial, draws);
      PointEdit edit(study, 0);
      edit.scale("friction.k1", draws.uniform(0.5, 2.0));
      edit.scale("friction.alpha", draws.uniform(0.5, 2.0));
      edit.scale("friction.lambda", draws.uniform(0.5, 2.0));
      edit.widen(draws.uniform(0.5, 1.5));
      study = edit.study();
    }
    study = study_of(minimal_manifest(random_spreads(draws)), {"trials=64"});
    expect_same_draws(study, drawer, trial, draws);
  }
}

}  // namespace
}  // namespace zerocount::study
