// paper-fig4: the hysteresis of the spring as positions at torque levels (paper, QL1 and Fig. 4): memory,
// wiping-out, congruency, odd symmetry and the tangent of eq. (1).
//
// Tolerances. At the end of a ramp at the rate r the amplifier's torque lags by r/(2πB), and a hold of t
// leaves exp(−2πB·t) of that, over the spring's lowest stiffness. The rotor's own ringing dies faster, by
// exp(−c·t/2J). Twice that, for two positions that are compared, is a few picometres on a radius of one
// metre: far below a count.
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/studies/shipped_study.hpp"
#include "tests/support/stop_elements.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t trials = 40;

double position_tolerance(const trial::TrialParameters& parameters) {
  const double rate = 2.0 * std::numbers::pi * parameters.amplifier.bandwidth;
  const double lag = parameters.command.torque.rate / rate * std::exp(-rate * parameters.command.hold);
  return 2.0 * lag / parameters.friction.uniform.k1;
}

/// Calls `look` with the parameters and the moves of each of the first trials.
template <class Look>
void look_at_trials(const Look& look) {
  const study::Study study = shipped_study("paper-fig4");
  ASSERT_EQ(study.moves, 9);
  for (std::int64_t index = 0; index < trials; ++index) {
    const trial::TrialParameters parameters = trial_of(study, "all", index);
    look(parameters, trial::run_trial(parameters).moves);
  }
}

TEST(PaperFig4, ClosedHysteresisLoopsAreForgotten) {
  look_at_trials([](const trial::TrialParameters& parameters, const std::vector<trial::MoveOutcome>& at) {
    const double tolerance = position_tolerance(parameters);
    ASSERT_LT(tolerance, 1e-10);
    for (const std::size_t again : {4, 6, 8}) {
      ASSERT_EQ(parameters.command.torque.levels[again], parameters.command.torque.levels[0]);
      EXPECT_NEAR(at[again].final_position, at[0].final_position, tolerance) << "point 1, level " << again;
    }
    EXPECT_NEAR(at[3].final_position, at[1].final_position, tolerance) << "point 2";
  });
}

TEST(PaperFig4, TheSpringRemembersReversalPointsUntilTheyAreWipedOut) {
  look_at_trials([](const trial::TrialParameters& parameters, const std::vector<trial::MoveOutcome>& at) {
    // The same torque at 3 and 5, but another place: friction is no function of position.
    ASSERT_EQ(parameters.command.torque.levels[2], parameters.command.torque.levels[5]);
    EXPECT_GT(at[5].final_position - at[2].final_position, 0.1 * at[0].final_position);
    EXPECT_EQ(at[0].reversal_depth, 0) << "virgin, and the load does not ring";
    EXPECT_EQ(at[1].reversal_depth, 1);
    EXPECT_EQ(at[2].reversal_depth, 2);
    EXPECT_EQ(at[3].reversal_depth, 3);
    EXPECT_LE(at[8].reversal_depth, 2) << "what lay inside the largest loop is forgotten";
    for (const trial::MoveOutcome& move : at) {
      EXPECT_EQ(move.outcome, trial::Outcome::open_loop);
      EXPECT_EQ(move.creep, 0.0);
      EXPECT_FALSE(move.broke_away);
    }
  });
}

/// The elongation at which the spring carries `torque`, reached from its present elongation.
double elongation_at(const StopElements& spring, double torque) {
  const bool rising = torque > spring.torque();
  double low = -1e-3, high = 1e-3;
  for (int i = 0; i < 55; ++i) {
    const double middle = 0.5 * (low + high);
    StopElements moved = spring;
    moved.move_to(middle);
    ((moved.torque() > torque) ? high : low) = middle;
  }
  return rising ? low : high;
}

// A parallel of stop elements (Prandtl–Ishlinskii) knows neither reversal points nor closures.
TEST(PaperFig4, PositionsAgreeWithStopElements) {
  const study::Study study = shipped_study("paper-fig4");
  for (std::int64_t index = 0; index < 5; ++index) {
    const trial::TrialParameters parameters = trial_of(study, "all", index);
    const std::vector<trial::MoveOutcome> moves = trial::run_trial(parameters).moves;
    StopElements spring(parameters.friction.uniform, 1500);
    for (std::size_t level = 0; level < moves.size(); ++level) {
      const double x = elongation_at(spring, parameters.command.torque.levels[level]);
      spring.move_to(x);
      const double tolerance = spring.error_bound(4) / parameters.friction.uniform.k1;
      ASSERT_LT(tolerance, 1e-7);
      EXPECT_NEAR(moves[level].final_position, x, tolerance + position_tolerance(parameters))
          << "trial " << index << ", level " << level;
    }
  }
}

TEST(PaperFig4, TheRecordHasTangentsBetweenTheTwoStiffnesses) {
  const TemporaryFolder folder;
  const std::string manifest = std::string(ZEROCOUNT_MANIFESTS) + "/paper-fig4.yaml";
  const ProgramResult run =
      zerocount_program({"run", manifest, "-o", "fig4.h5", "--set", "trials=1"}, folder.path());
  ASSERT_EQ(run.code, 0) << run.err;
  const reading::AllTrialsFile file(folder / "fig4.h5");
  const std::vector<layout::TraceRecord> record = file.trace_at(0, file.trace_count());
  const trial::TrialParameters parameters = trial_of(shipped_study("paper-fig4"), "all", 0);
  ASSERT_EQ(static_cast<std::int64_t>(record.size()), trial::samples_of_trial(parameters));

  const friction::FrictionParameters& spring = parameters.friction.uniform;
  const auto sigma = [&](std::size_t k) {  // J·dω/dt = u − c·ω − σ
    const double acceleration =
        (record[k + 1].omega - record[k - 1].omega) * 0.5 * parameters.controller.sample_rate;
    return record[k].drive_torque - parameters.plant.presliding_damping * record[k].omega -
           parameters.plant.inertia * acceleration;
  };
  double lowest = 1e9, highest = 0.0;
  const std::size_t chord = 4;
  const double tolerance = 0.01;  // the derivative of ω is taken from its samples
  for (std::size_t k = 1; k + chord + 1 < record.size(); ++k) {
    const double travel = record[k + chord].theta - record[k].theta;
    const bool reversed = record[k].omega * record[k + chord].omega <= 0.0;
    if (std::abs(travel) < 1e-8 || reversed || record[k].depth != record[k + chord].depth) continue;
    const double tangent = (sigma(k + chord) - sigma(k)) / travel;
    EXPECT_GT(tangent, spring.k1 * (1.0 - tolerance)) << k;
    EXPECT_LT(tangent, (spring.k1 + spring.k2) * (1.0 + tolerance)) << k;
    lowest = std::min(lowest, tangent);
    highest = std::max(highest, tangent);
  }
  EXPECT_LT(lowest, spring.k1 + 0.1 * spring.k2) << "softened along a branch";
  EXPECT_GT(highest, spring.k1 + 0.8 * spring.k2) << "stiff after a reversal";
}

// paper-fig6: creep and work hardening at held torques (paper, eq. 2 and Fig. 6) against the closed forms of
// dxh/dt = α·(|σ|ⁿ/λ − xh).

/// Hardening (rad) up to which the contact creeps under a torque (N m).
double asked(const trial::TrialParameters& parameters, double torque) {
  const friction::FrictionParameters& friction = parameters.friction.uniform;
  return std::pow(std::abs(torque), friction.n) / friction.lambda;
}

/// Whether a level loads the contact beyond the torque to which the earlier levels have hardened it.
bool goes_beyond(const std::vector<double>& levels, std::size_t level) {
  for (std::size_t before = 0; before < level; ++before) {
    if (std::abs(levels[before]) >= std::abs(levels[level])) return false;
  }
  return true;
}

TEST(PaperFig6, EachLevelCreepsToItsHardeningLimit) {
  const study::Study study = shipped_study("paper-fig6");
  for (std::int64_t index = 0; index < 25; ++index) {
    const trial::TrialParameters parameters = trial_of(study, "all", index);
    const std::vector<double>& levels = parameters.command.torque.levels;
    const double left = std::exp(-parameters.friction.uniform.alpha * parameters.command.hold);
    ASSERT_LT(left, 1e-3) << "the hold is long for creep";
    const trial::TrialOutcome outcome = trial::run_trial(parameters);
    double expected = 0.0, hardened = 0.0, remainder = 0.0;
    for (std::size_t level = 0; level < levels.size(); ++level) {
      if (goes_beyond(levels, level)) {
        const double step = asked(parameters, levels[level]) - hardened;
        expected += std::copysign(step, levels[level]);
        hardened += step;
        remainder += left * step;
      }
      const trial::MoveOutcome& move = outcome.moves[level];
      EXPECT_NEAR(move.creep, expected, remainder + 1e-4 * hardened) << "trial " << index << " " << level;
      EXPECT_FALSE(move.broke_away);
    }
  }
}

TEST(PaperFig6, HardeningIsTheTotalCreepInBothDirections) {
  const study::Study study = shipped_study("paper-fig6");
  for (std::int64_t index = 0; index < 8; ++index) {
    const WatchedTrial trial = watched(trial_of(study, "all", index));
    double crept = 0.0, last_hardening = 0.0, last_extension = 0.0;
    for (const trial::SampleRecord& sample : trial.samples) {
      ASSERT_GE(sample.xh, last_hardening) << sample.t;
      crept += std::abs(sample.xp - last_extension);
      last_hardening = sample.xh;
      last_extension = sample.xp;
    }
    EXPECT_NEAR(crept, last_hardening, 1e-9 * last_hardening);
  }
}

// Along the first ramp, σ = r·t, eq. (2) with n = 2 has the solution r²/λ·(t² − 2t/α + 2(1 − e^(−αt))/α²); at
// the held torque u after it, xh goes to u²/λ by e^(−αt). What the damper takes of the torque (c·dxp/dt)
// slows creep by less than 2αcu/λ, below one per cent here, and the torque is set at the samples, half a
// sample late on average.
TEST(PaperFig6, CreepUnderTheFirstTorqueFollowsTheClosedForm) {
  const study::Study study = shipped_study("paper-fig6");
  for (std::int64_t index = 0; index < 20; ++index) {
    trial::TrialParameters parameters = trial_of(study, "all", index);
    const friction::FrictionParameters& friction = parameters.friction.uniform;
    ASSERT_EQ(friction.n, 2.0);
    parameters.command.torque.levels.resize(1);
    const double torque = parameters.command.torque.levels[0];
    const double rate = parameters.command.torque.rate;
    const double end_of_ramp = torque / rate;
    const double alpha = friction.alpha;
    const auto along_ramp = [&](double t) {
      const double remembered = -std::expm1(-alpha * t) / alpha;
      return rate * rate / friction.lambda * (t * t - 2.0 * (t - remembered) / alpha);
    };
    const double goal = torque * torque / friction.lambda;
    const double slowing = 2.0 * alpha * parameters.plant.presliding_damping * torque / friction.lambda;
    ASSERT_LT(slowing, 0.01);
    double largest = 0.0;
    for (const trial::SampleRecord& sample : watched(parameters).samples) {
      const double after = sample.t - end_of_ramp;
      const double closed = after < 0.0 ? along_ramp(sample.t)
                                        : goal - (goal - along_ramp(end_of_ramp)) * std::exp(-alpha * after);
      largest = std::max(largest, std::abs(sample.xh - closed) / goal);
      ASSERT_EQ(sample.xp, sample.xh);
    }
    // e⁻¹ of the slowing at the most, where t = 1/α; and the half sample.
    EXPECT_LT(largest, 0.4 * slowing + 2.0 * alpha / parameters.controller.sample_rate) << index;
  }
}

TEST(PaperFig6, ARepeatedTorqueReturnsToThePositionExceptForCreep) {
  const study::Study study = shipped_study("paper-fig6");
  for (std::int64_t index = 0; index < 25; ++index) {
    const trial::TrialParameters parameters = trial_of(study, "all", index);
    ASSERT_EQ(parameters.command.torque.levels[2], parameters.command.torque.levels[0]);
    const std::vector<trial::MoveOutcome> moves = trial::run_trial(parameters).moves;
    const double crept = moves[2].creep - moves[0].creep;
    // The spring's loop has closed, but for what it rings at the steps in which the samples load it.
    const double step = parameters.command.torque.rate / parameters.controller.sample_rate;
    const double ringing = step / parameters.friction.uniform.k1;
    EXPECT_NEAR(moves[2].final_position - crept, moves[0].final_position, ringing) << index;
    EXPECT_GT(moves[2].final_position - moves[1].final_position, 1e-4) << "it has been let back between";
  }
}

}  // namespace
}  // namespace zerocount::testing
