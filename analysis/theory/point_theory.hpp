#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "core/friction/profile.hpp"
#include "core/theory/frozen_loop.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::theory {

/// Trials of a point that are examined at most.
inline constexpr std::int64_t max_trials_examined = 200;
/// Trials whose time constants, margins and bounds of the sampled loop are computed at most.
inline constexpr std::int64_t max_trials_examined_closely = 20;

using document::Range;

/// The integral gain and its bounds, in the unit of the manifest.
struct GainTheory {
  std::string name;  ///< "ki", or that of a cascade
  std::string unit;
  Range value;
  std::string_view left_out;  ///< of the controller, by criteria (6) and (7); empty: they apply
  Range stable_below;         ///< (6)
  Range unstable_above;       ///< (7)
  Range sampled_below;        ///< bound of the sampled loop about k1, or without a spring
  PointPrediction prediction;
  std::set<bool> sampled_stable;  ///< values of `value < sampled_below` in the trials
  bool observes{false};           ///< a disturbance observer takes the place of the integral
};

/// The paper's rules for the DAC and the sample rate.
struct DesignRules {
  Range dac_resolution, dac_bound;  ///< torque_unit
  std::string torque_unit;
  bool coarse_feedback{false};   ///< the bound uses the resolution Δx of the coarse encoder
  Range frequency, sample_rate;  ///< Hz
  std::int64_t trials{0};
  std::int64_t fine_enough{0};  ///< trials in which the DAC satisfies the bound
  std::int64_t fast_enough{0};  ///< trials in which the sample rate satisfies the rule
};

/// Criterion (6) and the sampled loop at the lowest k1 of the study.
struct LowestStiffness {
  study::LowEnd source;
  std::int64_t machines{0};  ///< machines with profiles that were examined; 0 without machines
  Range k1;                  ///< minimum of the profiles, or the low end of the distribution, N m/rad
  Range stable_below, sampled_below;  ///< in the unit of the gain
};

/// How fast the loop brings the error to zero.
struct Approach {
  Range time_constant;  ///< slowest of the loop, s
  /// Slowest time constants that hold up a move, s: without friction all of them; about a spring those
  /// without oscillation, because its hysteresis ends an oscillation that the linear loop lets ring.
  Range of_moves;
  double hold{0.0};              ///< of the shortest move, s
  std::int64_t longest_step{0};  ///< of the slowest move, counts; 0: no step
  double longest_time{0.0};      ///< from its start until it has arrived, with the dwell, s

  /// Whether moves may end before the loop has brought them to their targets.
  bool exceeds_hold() const { return of_moves.high > hold || longest_time > hold; }
};

/// A loop of trial_loops over the trials. A trial without a crossover does not change its ranges.
struct LoopRanges {
  std::string name;
  bool slides{false};
  Range bandwidth;        ///< Hz, of a loop that slides
  Range gain, gain_at;    ///< margin, dB, and its frequency, Hz
  Range phase, phase_at;  ///< margin, degrees, and its frequency, Hz
  std::set<LoopStability> stability;
  Range slow;                      ///< slowest time constants longer than the hold, s
  bool no_gain_stabilises{false};  ///< In some trial the loop is unstable with every factor of its gain.
};

/// Results of the theory (section 3 of the paper) for the trials of a design point.
struct PointTheory {
  std::string outside;  ///< reason why (6) and (7) do not apply; empty if they do
  bool free{false};     ///< no spring: `gain` and `approach` are of the loop without friction
  GainTheory gain;
  DesignRules rules;
  LowestStiffness lowest;
  Approach approach;
  std::vector<LoopRanges> loops;  ///< in the order of trial_loops
  std::vector<std::string> cut;   ///< states_without_loop of the first trial
};

/// The lowest k1 (N m/rad) of a rotor, and the profile that it is of.
struct KnownRotor {
  std::shared_ptr<const friction::Profile> k1;
  double lowest{0.0};
};

/// Examines the first trials of the point.
PointTheory examine(const study::Study& study, std::int64_t point);

/// Examines them under a condition.
/// @param rotors [machine] of the call before: a rotor that is the same again is not searched again
PointTheory examine(const study::Study& study, std::int64_t point, std::int64_t condition,
                    std::vector<KnownRotor>& rotors);

/// The theory of a design point: for data each range by itself, for people statements such as "(6) stable
/// below: 1.5e-04 N m/count". Loops are for data; people have a table of loop_description().
document::Description<PointTheory> point_theory_description();

/// Why a loop has no gain margin although it is unstable.
inline constexpr std::string_view no_gain_text = "none: no gain stabilises it";

/// "stable", "unstable in some trials" …
std::string stability_text(const LoopRanges& loop);

/// A loop and its margins.
document::Description<LoopRanges> loop_description();

/// Why approach.exceeds_hold(), for a warning: continues "the loop's slowest time constant".
std::string slowness_text(const Approach& approach);

}  // namespace zerocount::theory
