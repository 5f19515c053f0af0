// The measures of the position error, from the samples of random trials by their definitions, in both
// engines.
#include "core/trial/position_error.hpp"

#include "core/loop/encoder.hpp"
#include "core/trial/trial.hpp"
#include "tests/core/batch/batched_trials.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/each_seed.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// A random trial whose position error is measured, with targets between the counts or on them.
struct TrialsWithTolerances {
  static constexpr unsigned seeds = 300;

  explicit TrialsWithTolerances(unsigned seed) : draws(seed) {
    constexpr TrialKind kinds[] = {TrialKind::calm, TrialKind::ringing, TrialKind::breaking_away};
    p = trial_for_lanes(kinds[seed % 3], seed);
    count = loop::fine_resolution(p.encoder);
    for (const std::int64_t target : p.command.targets)
      targets.push_back((static_cast<double>(target) + (between ? draws.uniform(-0.5, 0.5) : 0.0)) * count);
    if (between) p.command.exact_targets = targets;
    p.verdict.position_error = true;
    // The first within the target's count: at rest, creep takes the rotor into it and out of it.
    p.verdict.tolerances = {
        {draws.log_uniform(0.01, 0.5) * count, draws.uniform(0.5, 2.0) * count, 40.0 * count}, 3};
    if (!draws.chance(0.5)) return;
    using enum motion::EncoderPlace;
    const double inertia = p.plant.inertia * draws.uniform(0.2, 1.0);
    const double frequency = 2.0 * std::numbers::pi * draws.uniform(30.0, 120.0);  // of the load alone
    p.plant.load = {.inertia = inertia,
                    .stiffness = inertia * frequency * frequency,
                    .damping = 0.2 * inertia * frequency,
                    .encoder = draws.chance(0.5) ? motor : load};
    p.verdict.other_mass = draws.chance(0.5) ? motor : load;
  }

  /// Whether the position error ε belongs to the load.
  /// @param other false: ε of the mass that closes the loop; true: ε of the other measured mass
  bool is_of_load(bool other) const {
    return motion::has_load(p.plant) &&
           (other ? *p.verdict.other_mass : p.plant.load.encoder) == motion::EncoderPlace::load;
  }

  testing::Draws draws;
  bool between{draws.chance(0.5)};
  trial::TrialParameters p;
  double count{0.0};
  std::vector<double> targets;  ///< [move] target position, rad
};

TEST_EACH_SEED(TrialsWithTolerances, SettleWhenTheErrorStaysWithinTheTolerance) {
  std::vector<trial::SampleRecord> records;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& r) { records.push_back(r); };
  const trial::TrialOutcome outcome = trial::run_trial(p, observers);
  for (const bool other : {false, true}) {
    if (other && !p.verdict.other_mass) return;
    std::size_t first = 0;
    for (std::size_t move = 0; move < targets.size(); ++move) {
      const auto samples = static_cast<std::size_t>(trial::samples_of_move(p, move));
      trial::MoveOutcome measured = outcome.moves[move];
      if (other) {
        measured.true_overshoot = measured.other_true_overshoot;
        measured.true_error = measured.other_true_error;
        measured.tolerance_settling_times = measured.other_tolerance_settling_times;
      }
      EXPECT_EQ(measured.number, static_cast<std::int64_t>(move));
      if (measured.outcome == trial::Outcome::nonfinite || measured.stopped) {
        EXPECT_TRUE(std::isnan(measured.true_overshoot));
        return;
      }
      const double step = targets[move] - (move == 0 ? 0.0 : targets[move - 1]);
      double overshoot = 0.0, last = 0.0;
      std::vector<std::size_t> settled(3, 0);
      for (std::size_t k = 0; k < samples; ++k) {
        const trial::SampleRecord& record = records[first + k];
        const double theta = is_of_load(other) ? record.load_theta : record.theta;
        const double error = targets[move] + (0.5 - p.initial.encoder_phase) * count - theta;
        last = static_cast<double>(p.command.targets[move]) + 0.5 - p.initial.encoder_phase - theta / count;
        if (step != 0.0) overshoot = std::max(overshoot, step > 0.0 ? -error : error);
        for (std::size_t i = 0; i < settled.size(); ++i)
          if (std::abs(error) > p.verdict.tolerances.limits[i]) settled[i] = k + 1;
      }
      EXPECT_NEAR(measured.true_overshoot, overshoot, 1e-9 * count + 1e-12 * std::abs(targets[move]));
      EXPECT_NEAR(measured.true_error, last, 1e-6 + 1e-9 * std::abs(last));
      for (std::size_t i = 0; i < settled.size(); ++i) {
        const double time = measured.tolerance_settling_times[i];
        if (settled[i] == samples) {
          EXPECT_TRUE(std::isnan(time));
        } else {
          EXPECT_DOUBLE_EQ(time, static_cast<double>(settled[i]) / p.controller.sample_rate);
        }
      }
      first += samples;
    }
  }
}

TEST_EACH_SEED(TrialsWithTolerances, HaveTheSameTimesInLanes) {
  const trial::TrialOutcome one = trial::run_trial(p);
  const trial::TrialOutcome other = run_batch({p}).front().outcome;
  for (std::size_t move = 0; move < one.moves.size(); ++move) {
    if (one.moves[move].broke_away) return;  // motions after a slide may part
    EXPECT_EQ(one.moves[move].number, other.moves[move].number);
    EXPECT_NEAR(one.moves[move].true_overshoot, other.moves[move].true_overshoot, 1e-5 * count);
    if (p.verdict.other_mass) {
      EXPECT_NEAR(one.moves[move].other_true_overshoot, other.moves[move].other_true_overshoot, 1e-5 * count);
    }
    for (const auto times : {&trial::MoveOutcome::tolerance_settling_times,
                             &trial::MoveOutcome::other_tolerance_settling_times}) {
      for (std::size_t i = 0; i < p.verdict.tolerances.count; ++i) {
        const double a = (one.moves[move].*times)[i], b = (other.moves[move].*times)[i];
        EXPECT_TRUE((std::isnan(a) && std::isnan(b)) || a == b) << a << " and " << b;
      }
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
