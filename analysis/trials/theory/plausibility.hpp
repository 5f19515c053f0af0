#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/loop/reference.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::theory {

/// A goal, and a trial whose parameters are examined to see whether it can meet the goal.
struct GoalOfTrial {
  const study::Study& study;
  const study::Goal& goal;  ///< Goal of the study. If it has none: zero counts at the end of the move.
  const trial::TrialParameters& trial;

  bool feeds_back_coarse() const { return trial.controller.encoder == loop::EncoderChoice::coarse; }
  double count() const;  ///< Size of a count of the encoder that closes the loop, rad.
  const loop::EncoderErrors& errors() const {
    return feeds_back_coarse() ? trial.encoder.coarse_errors : trial.encoder.fine_errors;
  }
  /// Full width of the goal's band or tolerance, rad.
  double width() const;
  /// Number of samples, in the goal's shortest move, at which the error must be within the band.
  double samples_within() const;

  std::string unit(const char* rotary) const;
  std::string length(double value) const;
  std::string torque(double value) const;
  std::string band_text() const;
};

/// A move of a trial that the goal judges.
struct MoveOfTrial {
  const GoalOfTrial& of;
  std::size_t number;
  /// Previous target and target of the move, relative to the start of the trial, before rounding to counts,
  /// rad.
  double from, to;

  double distance() const;
  double direction() const { return to < from ? -1.0 : 1.0; }
  loop::Reference reference() const;
  double allowed() const;  ///< Time from the start of the move within which the goal demands settling, s.
  /// Time within which the move must settle, s from its start: the goal's time or, if shorter, the hold
  /// (duration of the move).
  double within() const;
  std::string name() const { return "move " + std::to_string(number); }
};

/// Place of a warning as text: "point 2 (kp = 3), condition warm: ".
std::string place_text(const study::Study& study, std::int64_t point, std::int64_t setting);

/// The moves of the trial that the goal judges, without moves of length zero. If there are very many, only
/// the first ones. Empty without targets, and if the reference does not end.
std::vector<MoveOfTrial> moves_of(const GoalOfTrial& of);

/// Result of a plausibility test: a factor that is above 1 if the goal is out of reach, and the reason.
struct Doubt {
  double ratio{0.0};
  std::string text{};
};

// Moves that the drive, the reference or the encoder keeps from their goal.

/// Tests whether the tolerance or band is half of a step or more, so that a move is within it while still on
/// its way.
Doubt band_is_half_a_step(const GoalOfTrial& of);

/// Tests whether the hold (duration of a move) ends before the time that the goal allows the move. The goal
/// is then judged at the end of the hold.
Doubt hold_ends_before_the_goal(const MoveOfTrial& move);

/// Tests whether the reference is still farther from its end than the band or tolerance at
/// MoveOfTrial::within().
Doubt reference_is_on_its_way(const MoveOfTrial& move);

/// Tests whether the move takes longer than it may, even at the largest torque (shortest_move): with the
/// inertia that it has to move (of a second mass unless the motor can move without it), the constant
/// disturbance, and with ripple and vibration always in its favour. Before it slides, a law with presliding
/// motion is taken to have no friction; over what travel is five times breakaway over its softest stiffness.
/// Not said of an axis with a random vibration, which has no largest torque.
Doubt torque_is_too_small_for_the_move(const MoveOfTrial& move);

/// Tests whether constant disturbance and ripple at the target exceed the largest torque, so that the axis
/// cannot stay there.
Doubt torque_is_too_small_at_the_target(const MoveOfTrial& move);

/// Tests a goal that concerns the mass (motor or load) that the position loop does not read. At the target
/// the masses may be apart by
///
///     |ε + τ/kL| + F/kL + g/2
///
/// with the kinematic error ε there, torque τ and friction F of the load, and the gap g. Only a doubt: they
/// may stand closer.
Doubt other_mass_is_elsewhere_unseen(const MoveOfTrial& move);

/// Tests whether the velocity command of a cascade, which is rounded to 0 within resolution/(2·kv) of the
/// target, is too coarse. It raises only a doubt: the axis may run on into the tolerance.
Doubt velocity_command_is_too_coarse(const MoveOfTrial& move);

/// Tests whether the move takes longer than allowed at the limit of the velocity command. It raises only a
/// doubt, because the velocity loop may overshoot.
Doubt velocity_is_too_small_for_the_move(const MoveOfTrial& move);

/// Tests whether the systematic errors of the encoder (eccentricity, interpolation) are so large that it
/// reads the target nowhere within the tolerance.
Doubt encoder_misplaces_the_target(const MoveOfTrial& move);

// Goals that are allowed but that the encoder, its noise or the converter keeps an axis from meeting.

struct FrozenLoop;

/// Warnings that a goal is out of reach or doubtful, one for each test that fails, at the design point and in
/// the setting (condition at an age) where it fails worst:
///
///   - a tolerance below what zero counts hold: half a count, and half of one more where targets in SI units
///     are rounded
///   - a band or tolerance that the encoder's noise leaves too often, over all samples that must be within
///   it:
///     by an axis that stands in the middle of its count, or by the linear loop of trial_loops()
///   - a code of the converter that moves the axis by more than the whole band or tolerance even where its
///     friction is stiffest, Δu/(k1 + k2). The rule of the paper (issue 4 of its section 3), with k1, is
///     stricter than zero counts need (docs/findings.md, dac-resolution)
///   - those of moves (move_plausibility.cpp); those of the torque range without a goal too. One that is only
///     a doubt counts for moves that a simulation of the trial shows to miss the band or tolerance
///
/// A test of whole trials fails at a point in a setting if it fails in each of the trials examined
/// there, the first ones: few of very many points are examined, evenly spread. One of moves fails if it fails
/// for more of their moves than the goal permits, by more than chance.
std::vector<std::string> doubtful_goals(const study::Study& study);

/// Warnings like those of doubtful_goals(), but only from the tests that explain why a goal is not met.
std::vector<std::string> obstacles_to_goals(const study::Study& study);

/// Warnings like those of doubtful_goals(), but only from the tests that no value of the controller changes:
/// the torque is too small for a move, the reference is still on its way at MoveOfTrial::within(), or the
/// encoder misplaces the target.
std::vector<std::string> goals_out_of_reach(const study::Study& study);

enum class NoiseAt {
  axis,  ///< Response of the axis position to the encoder noise: L/(1 + L), L the open loop.
  error  ///< Response of the error that the loop reads to the encoder noise: 1/(1 + L), L the open loop.
};

struct NoiseResponse {
  /// Standard deviation of the response divided by the standard deviation of the encoder noise.
  double gain;
  /// Number of samples after which values are nearly independent (correlation at most 0.1).
  double correlated_samples;
};

/// The response of a linear loop to encoder noise. G is its transfer function (see NoiseAt), S the spectrum
/// of the noise, of mean 1:
///
///     gain² = R(0),   R(k) = 1/π·∫ |G|²·S·cos kα dα over 0 … π.
///
/// @param bandwidth bandwidth of the noise, Hz; infinite: white noise
NoiseResponse response_to_noise(const FrozenLoop& loop, NoiseAt at, double bandwidth);

// Loops that are allowed but that nobody would build on purpose.

/// Largest number of trials whose loops are examined by doubtful_loops(), over all design points.
inline constexpr std::int64_t max_trials_doubted = 100;

/// Warnings that a control loop is doubtful, one for each test that fails, at the design point where it fails
/// worst:
///
///   - a phase margin below 20°
///   - a delay margin (phase margin over crossover frequency) below one sample
///   - a move beyond the pre-sliding range, by a step or a profile, by a loop that is unstable while it
///   slides
///
/// The margins are those of trial_loops(), at rest and, where moves reach it, while sliding; of integral
/// control alone those at k1 + k2, because it is meant to work up to criterion (6) or beyond. They come from
/// the first trials of each point; of very many points some are examined, evenly spread.
std::vector<std::string> doubtful_loops(const study::Study& study);

}  // namespace zerocount::theory
