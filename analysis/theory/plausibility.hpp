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

/// A goal and a trial that is to meet it.
struct GoalOfTrial {
  const study::Study& study;
  const study::Goal& goal;  ///< Goal of the study. If it has none: zero counts at the end of the move.
  const trial::TrialParameters& trial;

  bool feeds_back_coarse() const { return trial.controller.encoder == loop::EncoderChoice::coarse; }
  double count() const;  ///< Resolution of the encoder that closes the loop, rad.
  const loop::EncoderErrors& errors() const {
    return feeds_back_coarse() ? trial.encoder.coarse_errors : trial.encoder.fine_errors;
  }
  /// Width from one end of the band or tolerance to the other, rad.
  double width() const;
  /// Number of samples of the goal's shortest move at which it must be within the band.
  double samples_within() const;

  std::string unit(const char* rotary) const;
  std::string length(double value) const;
  std::string torque(double value) const;
  std::string band_text() const;
};

/// A move of the trial that the goal judges.
struct MoveOfTrial {
  const GoalOfTrial& of;
  std::size_t number;
  /// Previous target and target, relative to the start of the trial, before rounding to counts, rad.
  double from, to;

  double distance() const;
  double direction() const { return to < from ? -1.0 : 1.0; }
  loop::Reference reference() const;
  double allowed() const;  ///< Time from the start of the move that the goal allows, s.
  double within() const;   ///< Time from the start of the move that goal and hold allow together, s.
  std::string name() const { return "move " + std::to_string(number); }
};

/// "point 2 (kp = 3), condition warm: ", the place of a warning.
std::string place_text(const study::Study& study, std::int64_t point, std::int64_t setting);

/// The moves that the goal judges, without moves of length zero. If there are very many, only the first ones.
/// Empty without targets, and if the reference does not end.
std::vector<MoveOfTrial> moves_of(const GoalOfTrial& of);

/// Result of a test: a factor that is above 1 where the goal is out of reach, and the reason.
struct Doubt {
  double ratio{0.0};
  std::string text{};
};

// Moves that the drive, the reference or the encoder keeps from their goal.

/// The tolerance or band is half of a step or more, so a move is within it while still on its way.
Doubt band_is_half_a_step(const GoalOfTrial& of);

/// The hold ends before the time that the goal allows the move: the goal is judged at the end of the hold.
Doubt hold_ends_before_the_goal(const MoveOfTrial& move);

/// The reference is still farther from its end than the band or tolerance at MoveOfTrial::within().
Doubt reference_is_on_its_way(const MoveOfTrial& move);

/// The move takes longer than it may, even at the largest torque (shortest_move): with the inertia that it
/// has to move (of a second mass unless the motor can move without it), the
/// constant disturbance, and with ripple and vibration always in its favour. Before it slides, a law with
/// presliding motion is taken to have no friction; over what travel is five times breakaway over its softest
/// stiffness. Not said of an axis with a random vibration, which has no largest torque.
Doubt torque_is_too_small_for_the_move(const MoveOfTrial& move);

/// Constant disturbance and ripple at the target exceed the largest torque.
Doubt torque_is_too_small_at_the_target(const MoveOfTrial& move);

/// A goal of the mass that the position loop does not read. At the target the masses may be apart by
///
///     |ε + τ/kL| + F/kL + g/2
///
/// with the kinematic error ε there, torque τ and friction F of the load, and the gap g. Only a doubt: they
/// may stand closer.
Doubt other_mass_is_elsewhere_unseen(const MoveOfTrial& move);

/// The velocity command of a cascade is rounded to 0 within resolution/(2·kv) of the target. Only a doubt:
/// the axis may run on into the tolerance.
Doubt velocity_command_is_too_coarse(const MoveOfTrial& move);

/// The move takes longer than allowed at the limit of the velocity command. Only a doubt, because the
/// velocity loop may overshoot.
Doubt velocity_is_too_small_for_the_move(const MoveOfTrial& move);

/// Because of its systematic errors (eccentricity, interpolation), the encoder reads the target nowhere
/// within the tolerance.
Doubt encoder_misplaces_the_target(const MoveOfTrial& move);

// Goals that are allowed but that the encoder, its noise or the converter keeps an axis from meeting.

struct FrozenLoop;

/// A warning for each test that fails, at the design point and in the setting where it fails worst:
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

/// Warnings like doubtful_goals(), but only from the tests that explain why a goal is not met.
std::vector<std::string> obstacles_to_goals(const study::Study& study);

/// Warnings like doubtful_goals(), but only from the tests that no value of the controller changes: the
/// torque is too small for a move, the reference is still on its way at MoveOfTrial::within(), or the encoder
/// misplaces the target.
std::vector<std::string> goals_out_of_reach(const study::Study& study);

enum class NoiseAt {
  axis,  ///< L/(1 + L): response of the axis to the noise.
  error  ///< 1/(1 + L): response of the error that the loop reads.
};

struct NoiseResponse {
  /// Standard deviation of the response over the standard deviation of the noise.
  double gain;
  /// Number of samples after which values are nearly independent (correlation at most 0.1).
  double correlated_samples;
};

/// The response G of a linear loop to noise of the encoder with the spectrum S, of mean 1:
///
///     gain² = R(0),   R(k) = 1/π·∫ |G|²·S·cos kα dα over 0 … π.
///
/// @param bandwidth of the noise, Hz
NoiseResponse response_to_noise(const FrozenLoop& loop, NoiseAt at, double bandwidth);

// Loops that are allowed but that nobody would build on purpose.

/// Largest number of trials whose loops are examined, over all design points.
inline constexpr std::int64_t max_trials_doubted = 100;

/// A warning for each test that fails, at the design point where it fails worst:
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
