// The measures of the true motion, from the samples of random trials by their definitions.
#include "core/trial/motion_measures.hpp"

#include "core/loop/encoder.hpp"
#include "core/trial/trial.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/core/trial/literal_trial.hpp"
#include "tests/core/trial/widened_trials.hpp"
#include "tests/support/random_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Real = long double;
constexpr Real nothing = std::numeric_limits<Real>::quiet_NaN();

/// The samples of a move, from which its measures are computed.
struct MoveSamples {
  std::vector<Real> error, position, reference, torque;  // counts, counts, counts, N m
  Real target{0}, from{0};                               // counts
};

struct Expected {
  Real rms{nothing}, range{nothing}, power{nothing}, noise{nothing};
  Real following_rms{nothing}, following_peak{nothing}, spike{nothing}, mean_position{nothing};
};

Real mean_square(const std::vector<Real>& values) {
  Real sum = 0;
  for (const Real value : values) sum += value * value;
  return sum / static_cast<Real>(values.size());
}

Real largest(const std::vector<Real>& values) {
  Real size = nothing;
  for (const Real value : values) size = std::fmax(size, std::abs(value));
  return size;
}

Expected measures_at_rest(const trial::TrialParameters& p, const MoveSamples& s, bool sine, Expected result) {
  const auto dwell = static_cast<std::size_t>(std::llround(p.verdict.dwell * p.controller.sample_rate));
  const auto inside = [&](Real e) { return std::abs(e) <= p.verdict.rest_band; };
  for (std::size_t k = 0; k + dwell <= s.error.size(); ++k) {
    const auto first = s.error.begin() + static_cast<std::ptrdiff_t>(k);
    if (!std::all_of(first, first + static_cast<std::ptrdiff_t>(dwell), inside)) continue;
    std::vector<Real> errors, torques, changes;
    for (std::size_t i = k; i < s.error.size(); ++i) {
      errors.push_back((sine ? s.reference[i] : s.target) - s.position[i]);
      torques.push_back(s.torque[i]);
      if (i > k) changes.push_back(s.torque[i] - s.torque[i - 1]);
    }
    result.rms = std::sqrt(mean_square(errors));
    result.range =
        *std::max_element(errors.begin(), errors.end()) - *std::min_element(errors.begin(), errors.end());
    result.power = mean_square(torques);
    if (!changes.empty()) result.noise = mean_square(changes);
    return result;
  }
  return result;
}

/// The measures of the true motion in a move, computed from their definitions.
/// @param lasts duration of the reference's travel, s; infinite for a sine
Expected measures_of(const trial::TrialParameters& p, const MoveSamples& s, Real lasts) {
  const bool sine = std::isinf(lasts);
  const Real rate = p.controller.sample_rate;
  const Real frequency = p.command.profile.frequency;
  std::vector<Real> following, after_reversals;
  for (std::size_t i = 0; i < s.error.size(); ++i) {
    const Real t = static_cast<Real>(i) / rate;
    if (t >= lasts || (sine && t < 1 / frequency)) continue;
    following.push_back(s.reference[i] - s.position[i]);
    for (int reversal = 2; sine; ++reversal) {
      const Real at = (2 * reversal + 1) / (4 * frequency);
      const Real until = at + 1 / (4 * frequency);
      if (until > static_cast<Real>(s.error.size()) / rate) break;
      if (t >= at && t < until) after_reversals.push_back(following.back());
    }
  }
  Expected result;
  if (!following.empty()) result.following_rms = std::sqrt(mean_square(following));
  result.following_peak = largest(following);
  result.spike = largest(after_reversals);
  const auto window = static_cast<std::size_t>(std::llround(p.verdict.window * p.controller.sample_rate));
  Real sum = 0;
  for (std::size_t i = s.position.size() - window; i < s.position.size(); ++i) sum += s.position[i];
  result.mean_position = sum / static_cast<Real>(window);
  return measures_at_rest(p, s, sine, result);
}

trial::TrialParameters random_trial(int i) {
  RandomBlocks draw(61000 + static_cast<std::uint64_t>(i));
  trial::TrialParameters p = widened_trial(WidenedKind::one_phase, static_cast<std::uint64_t>(i));
  p.verdict.motion = true;
  p.verdict.rest_band = draw.chance(0.3) ? 0.0 : std::floor(draw.log_uniform(1.0, 300.0));
  if (draw.chance(0.4)) {
    p.command.profile.shape = loop::ReferenceShape::sine;
    // No whole number of samples in a quarter of a period, so that rounding decides nothing.
    p.command.profile.frequency = draw.uniform(2.01, 40.0) / p.command.hold;
    p.command.profile.amplitude = draw.log_uniform(1.0, 300.0) * 4e-6;
  }
  if (draw.chance(0.2)) p.plant.load = {.inertia = 1e-4, .stiffness = 500.0, .damping = 0.02};
  if (p.plant.load.inertia > 0.0 && draw.chance(0.5)) p.plant.load.encoder = motion::EncoderPlace::load;
  return p;
}

void expect_near(double value, Real expected, const char* name) {
  if (std::isnan(expected)) {
    EXPECT_TRUE(std::isnan(value)) << name << " " << value;
  } else {
    EXPECT_NEAR(value, static_cast<double>(expected), 1e-9 * (1.0 + std::abs(static_cast<double>(expected))))
        << name;
  }
}

TEST(MotionMeasures, MatchTheirDefinitions) {
  int rests = 0, profiles = 0, sines = 0, spikes = 0, made = 0;
  for (int number = 0; number < 150; ++number) {
    SCOPED_TRACE(number);
    const trial::TrialParameters p = random_trial(number);
    std::vector<trial::SampleRecord> records;
    trial::TrialObservers observers;
    observers.sample = [&](const trial::SampleRecord& record) { records.push_back(record); };
    const trial::TrialOutcome outcome = trial::run_trial(p, observers);
    const std::vector<MoveSpan> spans = literal_spans(p);
    const Real resolution = 2 * std::numbers::pi_v<Real> / p.encoder.fine;
    const bool sine = p.command.profile.shape == loop::ReferenceShape::sine;
    const bool of_load = p.plant.load.inertia > 0.0 && p.plant.load.encoder == motion::EncoderPlace::load;
    Real position_before = p.initial.encoder_phase - 0.5L;
    for (std::size_t move = 0; move < spans.size(); ++move) {
      const trial::MoveOutcome& measured = outcome.moves[move];
      if (measured.outcome == trial::Outcome::nonfinite || measured.stopped) break;
      MoveSamples s;
      s.target = static_cast<Real>(p.command.targets[move]);
      s.from = move == 0 ? 0 : static_cast<Real>(p.command.targets[move - 1]);
      const LiteralMotion motion = sine ? LiteralMotion{} : literal_motion(p, move);
      for (std::size_t i = 0; i < spans[move].size; ++i) {
        const trial::SampleRecord& record = records[spans[move].first + i];
        const Real t = static_cast<Real>(i) / p.controller.sample_rate;
        const Real along = 2 * std::numbers::pi_v<Real> * p.command.profile.frequency * t;
        s.reference.push_back(sine ? s.target + p.command.profile.amplitude / resolution * std::sin(along)
                                   : s.from + literal_travel(motion, t));
        if (sine) {
          EXPECT_LE(std::abs(static_cast<Real>(record.target) - s.reference.back()), 0.5 + 1e-9) << i;
        }
        s.error.push_back(static_cast<Real>(record.target - record.count));
        s.position.push_back((of_load ? record.load_theta : record.theta) / resolution +
                             p.initial.encoder_phase - 0.5L);
        s.torque.push_back(record.torque);
      }
      const Expected expected =
          measures_of(p, s, sine ? std::numeric_limits<Real>::infinity() : motion.duration());
      expect_near(measured.rest_error_rms, expected.rms, "rest_error_rms");
      expect_near(measured.rest_error_range, expected.range, "rest_error_range");
      expect_near(measured.rest_motion_rms, expected.rms * resolution, "rest_motion_rms");
      expect_near(measured.rest_motion_range, expected.range * resolution, "rest_motion_range");
      expect_near(measured.rest_torque_power, expected.power, "rest_torque_power");
      expect_near(measured.rest_torque_noise, expected.noise, "rest_torque_noise");
      expect_near(measured.following_error_rms, expected.following_rms, "following_error_rms");
      expect_near(measured.following_error_peak, expected.following_peak, "following_error_peak");
      expect_near(measured.reversal_spike, expected.spike, "reversal_spike");
      const Real went = expected.mean_position - position_before;
      expect_near(measured.step_motion, went, "step_motion");
      EXPECT_EQ(measured.step_made,
                std::abs(went - (s.target - s.from)) <= 0.5 * std::fmax(1, std::abs(s.target - s.from)));
      position_before = expected.mean_position;
      rests += !std::isnan(expected.rms);
      profiles += !sine && !std::isnan(expected.following_rms);
      sines += sine;
      spikes += !std::isnan(expected.spike);
      made += measured.step_made;
    }
  }
  EXPECT_GT(rests, 100);
  EXPECT_GT(profiles, 50);
  EXPECT_GT(sines, 50);
  EXPECT_GT(spikes, 50);
  EXPECT_GT(made, 50);
}

// They are measured beside the others, and change none of these.
TEST(MotionMeasures, DoNotChangeOtherMeasures) {
  for (int number = 0; number < 40; ++number) {
    trial::TrialParameters p = random_trial(number);
    const trial::TrialOutcome with = trial::run_trial(p);
    p.verdict.motion = false;
    const trial::TrialOutcome without = trial::run_trial(p);
    for (std::size_t move = 0; move < with.moves.size(); ++move) {
      EXPECT_EQ(with.moves[move].final_position, without.moves[move].final_position);
      EXPECT_EQ(with.moves[move].outcome, without.moves[move].outcome);
      EXPECT_EQ(with.moves[move].jerk_count, without.moves[move].jerk_count);
      EXPECT_TRUE(std::isnan(without.moves[move].rest_error_rms));
      EXPECT_FALSE(without.moves[move].step_made);
    }
  }
}

// Where the rotor ended, against what the encoder says of it.

/// A trial, and the last sample of each of its moves.
struct EndedTrial {
  trial::TrialOutcome outcome;
  std::vector<trial::SampleRecord> ends;
};

EndedTrial run(const trial::TrialParameters& parameters) {
  std::vector<std::int64_t> last;
  std::int64_t samples = 0;
  for (std::size_t move = 0; move < trial::move_count(parameters); ++move) {
    samples += trial::samples_of_move(parameters, move);
    last.push_back(samples - 1);
  }
  EndedTrial trial;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& record) {
    if (record.k == last[trial.ends.size()]) trial.ends.push_back(record);
  };
  trial.outcome = trial::run_trial(parameters, observers);
  return trial;
}

std::int64_t ideal_count(const trial::TrialParameters& p, double theta) {
  return loop::read_count(loop::fine_encoder(p.encoder, p.initial.encoder_phase), theta);
}

/// Expects that the true errors put the rotor within the counts that an ideal encoder shows, and at its
/// actual place within these counts.
void expect_places_of_rotor(const trial::TrialParameters& p, const EndedTrial& trial) {
  ASSERT_EQ(trial.ends.size(), trial.outcome.moves.size());
  const double resolution = 2.0 * std::numbers::pi / p.encoder.fine;
  for (std::size_t i = 0; i < trial.ends.size(); ++i) {
    const trial::SampleRecord& end = trial.ends[i];
    const double error = trial.outcome.moves[i].true_error;
    const double rounding = 1e-12 * (1.0 + std::abs(end.theta / resolution));
    const auto beyond = static_cast<double>(ideal_count(p, end.theta) - end.target);
    EXPECT_GT(error + beyond, -0.5 - rounding);
    EXPECT_LE(error + beyond, 0.5 + rounding);
    const double middle = (static_cast<double>(end.target) + 0.5 - p.initial.encoder_phase) * resolution;
    EXPECT_NEAR(error, (middle - end.theta) / resolution, rounding);
  }
}

/// A trial with steps of 30 counts, the last one back, after which the loop holds the rotor at zero error.
/// The contact is hardened, so that no creep disturbs it.
trial::TrialParameters small_steps(std::uint64_t trial) {
  trial::TrialParameters p;
  p.command = {{30, 60, 90, 60}, 0.4};
  p.initial.hardening = 1e-3;
  p.initial.encoder_phase = std::fmod(0.05 + 0.31 * static_cast<double>(trial), 1.0);
  p.initial.position = 0.7 * static_cast<double>(trial);
  p.randomness.trial = trial;
  p.randomness.fine_missed = {3, 4};
  p.randomness.fine_noise = {5, 6};
  return p;
}

TEST(TrueError, IsWithinHalfACountOfTheFinalErrorForIdealEncoders) {
  std::int64_t zero = 0;
  std::int64_t others = 0;
  for (const TrialKind kind : {TrialKind::calm, TrialKind::ringing, TrialKind::breaking_away,
                               TrialKind::unlike_the_paper, TrialKind::spring_alone, TrialKind::coulomb,
                               TrialKind::amplified, TrialKind::arriving, TrialKind::remembering}) {
    for (std::uint64_t index = 3000; index < 3030; ++index) {
      SCOPED_TRACE(::testing::Message() << "kind " << static_cast<int>(kind) << " trial " << index);
      const trial::TrialParameters p = random_trial(kind, index);
      const EndedTrial trial = run(p);
      expect_places_of_rotor(p, trial);
      for (const trial::MoveOutcome& move : trial.outcome.moves) {
        EXPECT_NEAR(move.true_error, static_cast<double>(move.final_error), 0.5 + 1e-9);
        EXPECT_EQ(move.final_error == 0, move.true_error > -0.5 && move.true_error <= 0.5);
        ++(move.final_error == 0 ? zero : others);
      }
    }
  }
  EXPECT_GT(zero, 100);
  EXPECT_GT(others, 100);
}

TEST(TrueError, IsTheErrorOfTheRotorDespiteEncoderErrors) {
  for (std::uint64_t index = 0; index < 60; ++index) {
    SCOPED_TRACE(index);
    trial::TrialParameters p = random_trial(static_cast<TrialKind>(index % 3), 4000 + index);
    p.randomness = small_steps(index).randomness;
    p.encoder.fine_errors = {.eccentricity = 1e-3 * static_cast<double>(index % 4),
                             .interpolation = 0.3 * static_cast<double>(index % 5),
                             .noise = 0.5 * static_cast<double>(index % 7),
                             .missed = 0.05 * static_cast<double>(index % 6)};
    expect_places_of_rotor(p, run(p));
  }
}

TEST(TrueError, IsUndefinedWithoutATarget) {
  trial::TrialParameters p;
  p.command.torque.levels = {0.05, 0.0};
  p.command.hold = 0.1;
  for (const trial::MoveOutcome& move : trial::run_trial(p).moves) {
    EXPECT_EQ(move.outcome, trial::Outcome::open_loop);
    EXPECT_TRUE(std::isnan(move.true_error));
  }
}

TEST(TrueError, IsUndefinedIfTheMotionBecameNonfinite) {
  trial::TrialParameters p = small_steps(0);
  p.initial.mode = trial::InitialMode::slide;
  p.initial.velocity = 1e18;
  for (const trial::MoveOutcome& move : trial::run_trial(p).moves) {
    EXPECT_EQ(move.outcome, trial::Outcome::nonfinite);
    EXPECT_TRUE(std::isnan(move.true_error));
  }
}

}  // namespace
}  // namespace zerocount::testing
