#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/document/description.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "core/friction/profile.hpp"
#include "core/theory/frozen_loop.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::theory {

/// Largest number of trials of a design point that the theory examines.
inline constexpr std::int64_t max_trials_examined = 200;
/// Largest number of trials for which time constants, margins and bounds of the sampled loop are computed.
inline constexpr std::int64_t max_trials_examined_closely = 20;

using document::Range;

/// The integral gain and its bounds by the theory, as ranges over the trials, in the unit of the manifest.
struct GainTheory {
  std::string name;  ///< Name of the gain in the manifest: "ki", or the name of the cascade's integral gain.
  std::string unit;
  Range value;
  /// Part of the loop that criteria (6) and (7) do not model, see left_out_of_criteria(). Empty if they
  /// apply.
  std::string_view left_out;
  Range stable_below;    ///< Bound of criterion (6): the loop is stable with a smaller gain.
  Range unstable_above;  ///< Bound of criterion (7): the loop is unstable with a larger gain.
  /// Gain below which the sampled loop is stable, with a contact of stiffness k1 or, without a spring, the
  /// free axis.
  Range sampled_below;
  PointPrediction prediction;
  /// Results of the comparison `value < sampled_below` (gain stable in the sampled loop) in the trials: true,
  /// false or both.
  std::set<bool> sampled_stable;
  bool observes{false};  ///< True if a disturbance observer takes the place of the integral.
};

/// The paper's rules for the resolution of the DAC (torque converter) and for the sample rate, as ranges over
/// the trials.
struct DesignRules {
  /// Resolution of the DAC and its largest allowed value, in `torque_unit`.
  Range dac_resolution, dac_bound;
  std::string torque_unit;
  bool coarse_feedback{false};  ///< True if the bound uses the resolution Δx of the coarse encoder.
  /// Natural frequency of the motor on a spring k1 + k2, from which the rule for the sample rate follows, and
  /// the sample rate, Hz.
  Range frequency, sample_rate;
  std::int64_t trials{0};
  std::int64_t fine_enough{0};  ///< Number of trials in which the DAC satisfies the rule.
  std::int64_t fast_enough{0};  ///< Number of trials in which the sample rate satisfies the rule.
};

/// Criterion (6) and the sampled loop at the lowest contact stiffness k1 of the study.
struct LowestStiffness {
  study::LowEnd source;
  /// Number of machines whose friction varies along the axis and that were examined; 0 without machines.
  std::int64_t machines{0};
  Range k1;  ///< Lowest k1 along the axis over the machines, or low end of its distribution, N m/rad.
  /// Bounds of the integral gain by criterion (6) and by the sampled loop, at the lowest k1, in the unit of
  /// the gain.
  Range stable_below, sampled_below;
};

/// Times in which the loop brings the position error to zero, over the trials of a design point.
struct Approach {
  Range time_constant;  ///< Slowest time constant of the loop, s.
  /// Slowest time constants that delay a move, s. Without friction all time constants count. About a spring
  /// only those without oscillation count, because the spring's hysteresis ends an oscillation that the
  /// linear loop lets ring.
  Range of_moves;
  double hold{0.0};              ///< Hold (duration) of the shortest move, s.
  std::int64_t longest_step{0};  ///< Step length of the slowest move, counts; 0: no move is a step.
  /// Time from the start of the slowest move until it has arrived, including the dwell, s.
  double longest_time{0.0};

  /// Whether moves may end (hold) before the loop has brought them to their targets.
  bool exceeds_hold() const { return of_moves.high > hold || longest_time > hold; }
};

/// Ranges over the trials of the stability margins of one loop of trial_loops(). A trial in which the loop
/// has no crossover does not change the ranges.
struct LoopRanges {
  std::string name;
  bool slides{false};
  Range bandwidth;        ///< Crossover frequency, Hz; only if the loop slides.
  Range gain, gain_at;    ///< Gain margin, dB, and its frequency, Hz.
  Range phase, phase_at;  ///< Phase margin, degrees, and its frequency, Hz.
  std::set<LoopStability> stability;
  Range slow;  ///< Slowest time constants that are longer than the hold (duration of a move), s.
  /// True if in some trial the loop is unstable with every factor of its gain.
  bool no_gain_stabilises{false};
};

/// Results of the theory (section 3 of the paper) for the trials of a design point.
struct PointTheory {
  std::string outside;  ///< Reason why criteria (6) and (7) do not apply; empty if they do.
  /// True without a spring. `gain` and `approach` then describe the loop without friction.
  bool free{false};
  GainTheory gain;
  DesignRules rules;
  LowestStiffness lowest;
  Approach approach;
  std::vector<LoopRanges> loops;  ///< Loops in the order of trial_loops().
  /// Names of the load's states that cut the control loop in the first trial, see states_without_loop().
  std::vector<std::string> cut;
};

/// The lowest k1 (N m/rad) along a rotor, and the profile of k1 along it from which it was found.
struct KnownRotor {
  std::shared_ptr<const friction::Profile> k1;
  double lowest{0.0};
};

/// Examines by theory the first trials of the design point in a setting (condition at an age).
/// @param rotors [machine] result of the previous call; a rotor with the same profile is not searched again
PointTheory examine(const study::Study& study, std::int64_t point, std::int64_t setting,
                    std::vector<KnownRotor>& rotors);

/// The theory of a design point: for data each range by itself, for people statements such as "(6) stable
/// below: 1.5e-04 N m/count". Loops are for data; people have a table of loop_description().
document::Description<PointTheory> point_theory_description();

/// Text that explains why an unstable loop has no gain margin.
inline constexpr std::string_view no_gain_text = "none: no gain stabilises it";

/// Stability of a loop over the trials as text: "stable", "unstable in some trials" …
std::string stability_text(const LoopRanges& loop);

/// Output items of a loop and its stability margins.
document::Description<LoopRanges> loop_description();

/// Text on why approach.exceeds_hold() is true, for a warning: it continues "the loop's slowest time
/// constant".
std::string slowness_text(const Approach& approach);

}  // namespace zerocount::theory
